// SPDX-License-Identifier: MIT
// robot.debug of scripts: forms of drawings, and their limits. A script's fault fails its assert.

#include <gtest/gtest.h>

#include "lua_devices.h"

namespace ziggurat::lua {
namespace {

struct LuaMarkers : Devices {
  LuaMarkers() { robot_.set_draws_markers(true); }

  /// Each as "at > to" or "at o radius" or "at text", and its colour.
  std::vector<std::string> drawn() {
    std::vector<std::string> drawn;
    const v1::Command sent = command();
    for (const v1::Marker& marker : sent.markers()) {
      const auto place = [](const auto& values) {
        std::string text;
        for (const double value : values) {
          char number[32];
          std::snprintf(number, sizeof number, "%g ", value);
          text += number;
        }
        return text;
      };
      char end[64];
      std::snprintf(end, sizeof end, " %06x", marker.color());
      std::string what = place(marker.at());
      if (marker.to_size() > 0) what += "> " + place(marker.to());
      if (marker.radius() != 0) what += "o " + place(std::vector{marker.radius()});
      drawn.push_back(what + marker.text() + end);
    }
    return drawn;
  }
};

using Drawn = std::vector<std::string>;

TEST_F(LuaMarkers, TextsSayWhatToDraw) {
  EXPECT_RUNS(start(R"lua(
    robot.debug.draw("arrow(0,0,0.1)(1,-2,+3)(red)")
    robot.debug.draw(" ring ( 0, 0, 1e-1 ) ( 0.5 ) ( 255, 128.9, 0 ) ")
    robot.debug.draw("text(0,0,0.2)(see (here))(0,0,255)")
    robot.debug.draw("arrow(blue)(0,0,0)(1,1,1)")
    robot.debug.draw("ring(0,0,0)(2)")
  )lua"));
  EXPECT_EQ(drawn(),
            (Drawn{"0 0 0.1 > 1 -2 3  ff0000", "0 0 0.1 o 0.5  ff8000", "0 0 0.2 see (here) 0000ff",
                   "0 0 0 > 1 1 1  0000ff", "0 0 0 o 2  000000"}));
}

TEST_F(LuaMarkers, TablesSayWhatToDraw) {
  EXPECT_RUNS(start(R"lua(
    robot.debug.draw{at = {0, 0, 0.5}, to = vector3(1, 2, 3), color = "green"}
    robot.debug.draw{at = {x = 1, y = 2, z = 3}, radius = 0.25, color = "1,2,3"}
    robot.debug.draw{at = {0, 0, 0}, text = "grüezi"}
  )lua"));
  EXPECT_EQ(drawn(),
            (Drawn{"0 0 0.5 > 1 2 3  00ff00", "1 2 3 o 0.25  010203", "0 0 0 grüezi 000000"}));
}

TEST_F(LuaMarkers, AreDrawnForOneTick) {
  EXPECT_RUNS(start(R"lua(robot.debug.draw("ring(0,0,0)(1)(red)") function step() end)lua"));
  EXPECT_EQ(drawn().size(), 1U);
  EXPECT_RUNS(step());
  EXPECT_EQ(drawn(), Drawn{});
}

TEST_F(LuaMarkers, OtherFormsAreErrorsThatTeach) {
  EXPECT_RUNS(start(R"lua(
    local draw = robot.debug.draw
    refused("draw%(text or table%) expected, got 0", draw)
    for _, text in ipairs{"", "arrow", "arrow(0,0,0)", "circle(0,0,0)(1)(red)", "ring(0,0,0)(1)(mauve)",
                          "ring(0,0)(1)(red)", "ring(0,0,0)(x)(red)", "arrow(0,0,nan)(1,1,1)(red)",
                          "arrow(0,0,0)(1,1,1)(256,0,0)", "arrow(0,0,0)(1,1,1)(red", "arrow(0,0,0)(1,1,1)(red)(x)"} do
      refused("'ring%(x,y,z%)%(radius%)%(color%)'", draw, text)
    end
    for _, drawing in ipairs{{}, {at = {0, 0, 0}}, {at = {0, 0}, radius = 1}, {to = {0, 0, 0}},
                             {at = {0, 0, 0}, radius = 1, text = "x"}, {at = {0, 0, "0"}, radius = 1}} do
      refused("{at =, radius =, color =}", draw, drawing)
    end
    refused("'mauve' is no color", draw, {at = {0, 0, 0}, radius = 1, color = "mauve"})
  )lua"));
  EXPECT_EQ(drawn(), Drawn{});
}

TEST_F(LuaMarkers, LimitsAreErrorsThatAScriptMayCatch) {
  EXPECT_RUNS(start(R"lua(
    local draw = robot.debug.draw
    local long = ("x"):rep(100)
    draw{at = {0, 0, 0}, text = long}
    refused("must have 1 to 100 bytes", draw, {at = {0, 0, 0}, text = long .. "x"})
    refused("must have 1 to 100 bytes", draw, {at = {0, 0, 0}, text = ""})
    refused("within %-1e6 and 1e6", draw, {at = {1e7, 0, 0}, radius = 1})
    refused("within %-1e6 and 1e6", draw, {at = {0/0, 0, 0}, radius = 1})
    refused("must be above 0", draw, {at = {0, 0, 0}, radius = 0})
    for i = 2, 1000 do draw("ring(0,0,0)(1)(red)") end
    refused("draws more than 1000 markers at this tick", draw, "ring(0,0,0)(1)(red)")
  )lua"));
  EXPECT_EQ(drawn().size(), 1000U);
}

TEST_F(LuaMarkers, NeedTheActuator) {
  robot_.set_draws_markers(false);
  EXPECT_RUNS(start("assert(robot.debug == nil)"));
}

}  // namespace
}  // namespace ziggurat::lua
