// SPDX-License-Identifier: MIT
#include "reports/report_card.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

namespace ziggurat::reports {
namespace {

using network::Reaction;

Reaction reaction(std::uint32_t tick, double seconds,
                  Reaction::Kind kind = Reaction::Kind::in_time) {
  return {seconds, tick, 0, 0, 0, kind};
}

/// A hundred ticks; "quick" answers within 0.8 ms, "slow" misses two: the answer to tick 7 comes
/// after 30 ms, that to tick 8 never.
ReportCard card(const std::string& gate, std::uint64_t warm_up = 0) {
  ReportCard result;
  result.scene = "scenes/some.argos";
  result.seed = 42;
  result.date = "2026-11-22T18:55:00Z";
  result.period_s = 0.02;
  result.ticks = 99;
  result.warm_up = warm_up;
  result.gate = parse_gate(gate);
  result.robots = {"r0, the first"};
  ControllerCard quick{"quick", {}}, slow{"slow", {}};
  slow.deadlines = {{scene::DeadlineAction::hold, 18, 0}};
  for (std::uint32_t tick = 0; tick < 100; ++tick) {
    quick.reactions.push_back(reaction(tick, 0.8e-3));
    if (tick == 7) {
      slow.reactions.push_back(reaction(tick, 30e-3, Reaction::Kind::late));
    } else if (tick == 8) {
      slow.reactions.push_back(reaction(tick, 25e-3, Reaction::Kind::unanswered));
    } else {
      slow.reactions.push_back(reaction(tick, 1e-3));
    }
    if (tick > 0) result.starts.push_back({0, tick, tick == 9 ? 5e-3 : 1e-4, tick == 9});
  }
  result.controllers = {quick, slow};
  complete(result);
  return result;
}

TEST(ReportCard, TheGateIsMetIfAllMeetIt) {
  EXPECT_TRUE(passes(card("p99<40ms,misses<3%")));
  EXPECT_FALSE(passes(card("misses<1%")));
  EXPECT_FALSE(passes(card("max<20ms")));
  EXPECT_TRUE(passes(card("late<2")));
  EXPECT_FALSE(passes(card("run<2")));
  EXPECT_TRUE(passes(card("run<3,jitter<1ms")));
}

TEST(ReportCard, WithoutADeadlineNothingIsMissedSoNoGateOnMissesIsMet) {
  for (const char* gate : {"misses<100%", "run<9", "p99<40ms"}) {
    ReportCard waiting = card(gate);
    for (auto& controller : waiting.controllers)
      controller.deadlines = {{scene::DeadlineAction::wait, 0, 0}};
    EXPECT_EQ(passes(waiting), is_time(waiting.gate[0].subject)) << gate;
    const bool tells_why =
        to_text(waiting).find(": no controller had a deadline") != std::string::npos;
    EXPECT_EQ(tells_why, reports::is_of_misses(waiting.gate[0].subject)) << to_text(waiting);
  }
}

TEST(ReportCard, LateAndMissingAnswersCountForTimes) {
  EXPECT_FALSE(passes(card("p99<20ms"))) << "two of a hundred took longer";
  EXPECT_TRUE(passes(card("p90<2ms")));
}

TEST(ReportCard, TheWarmUpDoesNotCount) {
  const ReportCard warm = card("max<2ms,misses<1,late<1", 10);
  EXPECT_TRUE(passes(warm));
  EXPECT_EQ(warm.controllers[1].statistics.ticks, 90U);
  EXPECT_EQ(warm.counted_starts, 90U);
  EXPECT_FALSE(passes(card("max<2ms", 8)));
  EXPECT_NE(to_text(warm).find("the first 10 not counted"), std::string::npos);
}

TEST(ReportCard, WhereNothingCountsNoGateIsMet) {
  const ReportCard warm = card("misses<1,late<1", 100'000);
  EXPECT_FALSE(passes(warm));
  EXPECT_NE(to_text(warm).find("MISSED  misses<1: no observation counts"), std::string::npos)
      << to_text(warm);
  ReportCard none = card("late<100");
  none.controllers.clear();
  EXPECT_FALSE(passes(none));
  EXPECT_NE(to_text(none).find("gate: not met: no controller was measured"), std::string::npos);
  none.gate.clear();
  EXPECT_TRUE(passes(none));
}

TEST(ReportCard, WhoNeverAnsweredMeetsNothingOnTimes) {
  ReportCard empty = card("p50<1s");
  empty.controllers.push_back({"silent", {}});
  complete(empty);
  EXPECT_FALSE(passes(empty));
}

TEST(ReportCard, NamesTheWorstTicksAndWhatWasMissed) {
  const std::string text = to_text(card("max<20ms"));
  for (const char* part :
       {"scenes/some.argos, seed 42, 2026-11-22T18:55:00Z", "99 ticks of 20 ms",
        "1 of 99 began late", "max 5.000 ms", "'slow', deadline hold:18",
        "98 answered in time, 1 late, 1 never", "misses at 2 of 100 ticks, at most 2 in a row",
        "30.000 ms at tick 7", "25.000 ms at tick 8 (never answered)", "MISSED  max<20ms: 30 ms",
        "gate: not met"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
}

TEST(ReportCard, IsJson) {
  const auto json = nlohmann::json::parse(to_json(card("misses<1%")));
  EXPECT_FALSE(json["passed"]);
  EXPECT_EQ(json["scene"], "scenes/some.argos");
  EXPECT_EQ(json["seed"], 42);
  EXPECT_EQ(json["date"], "2026-11-22T18:55:00Z");
  EXPECT_EQ(json["period_s"], 0.02);
  EXPECT_EQ(json["wall_start_lateness_s"]["max"], 5e-3);
  const auto& slow = json["controllers"][1];
  EXPECT_EQ(slow["misses"], 2);
  EXPECT_EQ(slow["longest_run_of_misses"], 2);
  EXPECT_EQ(slow["deadlines"], nlohmann::json{"hold:18"});
  EXPECT_EQ(slow["answers"], 99);
  EXPECT_EQ(slow["wall_latency_s"]["p99"], 25e-3);
  // 29 ms up, 5 down, 24 down, of 99 changes.
  EXPECT_NEAR(slow["wall_jitter_s"].get<double>(), 58e-3 / 99, 1e-12);
  std::uint64_t observations = 0;
  for (const auto& bin : slow["histogram"]) observations += bin["count"].get<int>();
  EXPECT_EQ(observations, 100U);
}

TEST(ReportCard, IsATableOfTicks) {
  std::istringstream csv(to_csv(card("max<1s", 8)));
  std::vector<std::string> lines;
  for (std::string line; std::getline(csv, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 201U);
  EXPECT_EQ(lines[0],
            "world,tick,start_lateness_s,warm_up,controller,robot,outcome,wall_latency_s");
  EXPECT_EQ(lines[1], "0,0,,1,quick,\"r0, the first\",in_time,0.000800000");
  EXPECT_EQ(lines[16], "0,7,0.000100000,1,slow,\"r0, the first\",late,0.030000000");
  EXPECT_EQ(lines[18], "0,8,0.000100000,0,slow,\"r0, the first\",unanswered,0.025000000");
}

TEST(ReportCard, IsAPictureWithDeadlineAndVerdict) {
  const std::string svg = to_svg(card("p99<1s"));
  for (const char* part :
       {"controller quick", "<path", "class=\"mark\"", "deadline hold:18", "gate met",
        "met: p99&lt;1s: 25 ms", "98 in time, 1 late, 1 never", "seed 42", "period 20 ms"}) {
    EXPECT_NE(svg.find(part), std::string::npos) << part;
  }
  EXPECT_NE(to_svg(card("p99<1ms")).find("gate NOT met"), std::string::npos);
}

TEST(Statistics, PercentilesAreExact) {
  std::vector<double> values;
  for (int i = 1000; i >= 1; --i) values.push_back(i);
  const Percentiles p = percentiles(values);
  EXPECT_EQ(p.p50, 500);
  EXPECT_EQ(p.p90, 900);
  EXPECT_EQ(p.p99, 990);
  EXPECT_EQ(p.p999, 999);
  EXPECT_EQ(p.max, 1000);
}

TEST(Statistics, ARunOfMissesEndsAtAGapAndAtAReset) {
  using Kind = Reaction::Kind;
  const std::vector<Reaction> reactions{{1, 0, 0, 0, 0, Kind::late},    {1, 1, 0, 0, 0, Kind::late},
                                        {1, 3, 0, 0, 0, Kind::late},    {1, 4, 1, 0, 0, Kind::late},
                                        {1, 5, 1, 0, 0, Kind::in_time}, {1, 5, 1, 9, 0, Kind::late},
                                        {1, 6, 1, 0, 0, Kind::in_time}};
  const Statistics found = measure(reactions);
  EXPECT_EQ(found.longest_run, 2U) << "ticks 0 and 1, and 4 and 5 of the second world";
  EXPECT_EQ(found.misses, 5U);
  EXPECT_EQ(found.ticks, 6U) << "two robots at tick 5";
}

TEST(Statistics, BinsGrowByTheirFactorAndHoldTheExtremes) {
  EXPECT_NEAR(bins::begin_of(21) / bins::begin_of(20), std::pow(10, 0.05), 1e-12);
  EXPECT_EQ(bins::of(0), 0U);
  EXPECT_EQ(bins::of(1e9), bins::count - 1);
  EXPECT_EQ(measure({}).wall_s.max, 0);
}

TEST(ReportCard, InjectionsAsText) {
  using namespace std::chrono_literals;
  using network::Injection;
  EXPECT_EQ(to_text(Injection{{5ms, 2ms, 0.01}, {5ms, 2ms, 0.01}}),
            "each way 5 ms ± 2 ms, 1 % lost");
  EXPECT_EQ(to_text(Injection{{5ms, {}, 0}, {{}, {}, 1}}),
            "observations 5 ms; commands 100 % lost");
  EXPECT_EQ(to_text(Injection{{}, {1ms, {}, 0}}), "commands 1 ms");
}

}  // namespace
}  // namespace ziggurat::reports
