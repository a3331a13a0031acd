// SPDX-License-Identifier: MIT
#include "reports/plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace ziggurat::reports {
namespace {

Panel panel(std::vector<double> y) {
  return {
      "Force <now>", "d [m]", "F [N]", {0.01, 0.02, 0.04}, {{"curve", "#c30", true, std::move(y)}}};
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(Plot, DrawsACurveThroughItsPoints) {
  const std::string svg = to_svg("A & B", {panel({1, 0.1, 0.01})});
  EXPECT_EQ(svg.find("<svg"), 0u);
  EXPECT_EQ(count(svg, "fill=\"none\""), 1u);
  EXPECT_EQ(count(svg, "L"), 2u) << svg;
  EXPECT_NE(svg.find("A &amp; B"), std::string::npos);
  EXPECT_NE(svg.find("Force &lt;now>"), std::string::npos);
}

TEST(Plot, ShowsCharactersThatAreNotSeenAsNumbers) {
  Panel hostile = panel({1, 0.1, 0.01});
  hostile.title = "r\u202e1\x1b";
  EXPECT_NE(to_svg("", {hostile}).find("r\\u202e1\\u001b"), std::string::npos);
}

TEST(Plot, LiftsThePenWhereThereIsNoPoint) {
  const std::string svg = to_svg("", {panel({1, std::nan(""), 0.01})});
  EXPECT_EQ(count(svg, "L"), 0u);
}

TEST(Plot, LinearAxesHaveRoundNumbersAndErrorBars) {
  Panel linear = panel({-1, 0, 2});
  linear.scale = Scale::linear;
  linear.curves[0].spread = {0, 0.5, 0};
  const std::string svg = to_svg("", {linear});
  for (const char* number : {">-1<", ">-0.5<", ">0<", ">1.5<", ">0.03<"})
    EXPECT_NE(svg.find(number), std::string::npos) << number << " in " << svg;
  EXPECT_EQ(count(svg, "<circle"), 3u);
}

TEST(Plot, SaysWhenAllIsZero) {
  const std::string svg = to_svg("", {panel({0, 0, 0})});
  EXPECT_NE(svg.find("zero everywhere"), std::string::npos);
  EXPECT_EQ(count(svg, "<path"), 0u);
}

}  // namespace
}  // namespace ziggurat::reports
