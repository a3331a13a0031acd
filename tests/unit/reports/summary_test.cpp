// SPDX-License-Identifier: MIT
#include "reports/summary.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace ziggurat::reports {
namespace {

TEST(Summary, ExitCodeFollowsTheEnding) {
  Summary summary;
  EXPECT_EQ(exit_code_of(summary), 0);
  summary.failures.push_back({"r0", "drive", 4, "why"});
  EXPECT_EQ(exit_code_of(summary), 3);
  summary.ending = Ending::interrupted;
  EXPECT_EQ(exit_code_of(summary), 130);
  summary.ending = Ending::forced;
  EXPECT_EQ(exit_code_of(summary), 130);
  summary.ending = Ending::shut_down;
  EXPECT_EQ(exit_code_of(summary), 3);
  summary.failures.clear();
  EXPECT_EQ(exit_code_of(summary), 0);
  summary.ending = Ending::controller_vanished;
  EXPECT_EQ(exit_code_of(summary), 3);
}

TEST(Summary, ARecordingThatIsNotCompleteIsAFault) {
  Summary summary;
  EXPECT_FALSE(nlohmann::json::parse(to_json(summary)).contains("recording_failure"));
  summary.recording_failure = "a.mcap: cannot be written: full; the recording ends before tick 4";
  EXPECT_EQ(exit_code_of(summary), exit_code::fault);
  EXPECT_EQ(nlohmann::json::parse(to_json(summary))["recording_failure"],
            summary.recording_failure);
  EXPECT_NE(to_text(summary).find("not recorded in whole: " + summary.recording_failure + "\n"),
            std::string::npos);
  summary.failures.push_back({"r0", "drive", 4, "why"});
  EXPECT_EQ(exit_code_of(summary), exit_code::controller_failed);
}

TEST(Summary, TextsOfPeersMakeNoLinesOfIts) {
  Summary summary;
  summary.shutdown_reason = "enough\n  seed 1, hash 0";
  summary.result = {"judge", "done\n  1 failed: robot r0"};
  EXPECT_NE(to_text(summary).find("enough\n      seed 1"), std::string::npos) << to_text(summary);
  EXPECT_NE(to_text(summary).find("done\n      1 failed"), std::string::npos) << to_text(summary);
}

TEST(Summary, JsonHasTheRatesAndTheHashInFull) {
  Summary summary;
  summary.ticks = 20;
  summary.simulated_s = 4;
  summary.wall[timing::Phase::wait] = 0.375;
  summary.wall[timing::Phase::solve] = 0.125;
  summary.seed = 7;
  summary.hash = 0xAB;
  summary.failures.push_back({"r\xff", "drive", 4, "not UTF-8: \xff"});
  summary.departures.push_back({"r1", "drive", 5});
  const auto json = nlohmann::json::parse(to_json(summary));
  EXPECT_EQ(json["left"],
            (nlohmann::json{{{"robot", "r1"}, {"controller", "drive"}, {"tick", 5}}}));
  EXPECT_NE(to_text(summary).find("1 left before the end: robot r1 at tick 5"), std::string::npos);
  EXPECT_EQ(json["real_time_factor"], 8.0);
  EXPECT_EQ(json["ticks_per_s"], 40.0);
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["hash"], "00000000000000ab");
  EXPECT_EQ(json["failures"][0]["tick"], 4);
  EXPECT_EQ(to_json(summary).find('\n'), std::string::npos);
}

TEST(Summary, TellsWhereTheSolverDidNotConverge) {
  Summary summary;
  EXPECT_FALSE(nlohmann::json::parse(to_json(summary)).contains("solver"));
  summary.solver = {1000, 0, 1e-9};
  EXPECT_EQ(to_text(summary).find("converge"), std::string::npos);
  summary.solver = {1000, 3, 0.25};
  const auto json = nlohmann::json::parse(to_json(summary));
  EXPECT_EQ(json["solver"]["islands"], 1000);
  EXPECT_EQ(json["solver"]["not_converged"], 3);
  EXPECT_EQ(json["solver"]["worst_residual"], 0.25);
  EXPECT_NE(to_text(summary).find("the solver did not converge in 3 of 1000 islands"),
            std::string::npos);
}

TEST(Summary, TextSurvivesARunOfNoTime) {
  EXPECT_NE(to_text(Summary{}).find("0 ticks"), std::string::npos);
  EXPECT_EQ(to_text(Summary{}).find("nan"), std::string::npos);
}

}  // namespace
}  // namespace ziggurat::reports
