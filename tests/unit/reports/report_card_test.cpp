#include "reports/report_card.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace ziggurat::reports {
namespace {

/// A hundred ticks; "quick" answers within 1 ms, "slow" misses two and takes 30 ms at tick 7.
ReportCard card(const std::string& gate) {
  ReportCard result;
  result.ticks = 100;
  result.late_ticks = 1;
  result.gate = parse_gate(gate);
  ControllerCard quick{"quick", {}, 0}, slow{"slow", {}, 2};
  for (std::uint64_t tick = 0; tick < 100; ++tick) {
    quick.latencies.add(0.8e-3, tick);
    if (tick < 98) slow.latencies.add(tick == 7 ? 30e-3 : 1e-3, tick);
  }
  result.controllers = {quick, slow};
  return result;
}

TEST(ReportCard, TheGateIsMetIfAllMeetIt) {
  EXPECT_TRUE(passes(card("p99<40ms,misses<3%")));
  EXPECT_FALSE(passes(card("misses<1%")));
  EXPECT_FALSE(passes(card("max<20ms")));
  EXPECT_TRUE(passes(card("late<2")));
}

TEST(ReportCard, WhoNeverAnsweredMeetsNothingOnTimes) {
  ReportCard empty = card("p50<1s");
  empty.controllers.push_back({"silent", {}, 100});
  EXPECT_FALSE(passes(empty));
}

TEST(ReportCard, NamesTheWorstTickAndWhatWasMissed) {
  const std::string text = to_text(card("max<20ms"));
  EXPECT_NE(text.find("30.000 ms at tick 7"), std::string::npos) << text;
  EXPECT_NE(text.find("MISSED  max<20ms: 30 ms"), std::string::npos) << text;
  EXPECT_NE(text.find("gate: not met"), std::string::npos) << text;
}

TEST(ReportCard, IsJson) {
  const auto json = nlohmann::json::parse(to_json(card("misses<1%")));
  EXPECT_FALSE(json["passed"]);
  EXPECT_EQ(json["controllers"][1]["misses"], 2);
  std::uint64_t answers = 0;
  for (const auto& bin : json["controllers"][1]["histogram"]) answers += bin["count"].get<int>();
  EXPECT_EQ(answers, 98U);
}

TEST(ReportCard, IsAPicture) {
  const std::string svg = to_svg(card("p99<1s"));
  EXPECT_NE(svg.find("controller quick"), std::string::npos);
  EXPECT_NE(svg.find("<path"), std::string::npos);
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
