// SPDX-License-Identifier: MIT
// Markers of the C++ client.

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "one_robot.h"

namespace ziggurat {
namespace {

v1::RobotDescription painter() {
  v1::RobotDescription robot;
  robot.set_id("painter");
  robot.set_draws_markers(true);
  return robot;
}

TEST(ClientMarkers, AreSentOnce) {
  OneRobot one(painter());
  ASSERT_TRUE(one.robot().draws());
  one.robot().draw_arrow({1, 2, 3}, {4, 5, 6}, {255, 0, 1});
  one.robot().draw_ring({0, 0, 0}, 0.5, {});
  one.robot().draw_text({0, 0, 1}, "a\xff", {});
  const v1::Command command = one.command();
  ASSERT_EQ(command.markers_size(), 3);
  EXPECT_EQ(command.markers(0).at(2), 3);
  EXPECT_EQ(command.markers(0).to(0), 4);
  EXPECT_EQ(command.markers(0).color(), 0xFF0001U);
  EXPECT_EQ(command.markers(1).radius(), 0.5);
  EXPECT_EQ(command.markers(2).text().front(), 'a') << "made valid UTF-8";
  EXPECT_NE(command.markers(2).text(), "a\xff");
  EXPECT_EQ(one.command().markers_size(), 0);
}

TEST(ClientMarkers, ThrowBeyondTheirBounds) {
  OneRobot one(painter());
  Robot& robot = one.robot();
  EXPECT_THROW(robot.draw_arrow({NAN, 0, 0}, {}, {}), std::invalid_argument);
  EXPECT_THROW(robot.draw_arrow({}, {0, 0, -2e6}, {}), std::invalid_argument);
  for (const double radius : {0.0, -1.0, 2e6, static_cast<double>(NAN)}) {
    EXPECT_THROW(robot.draw_ring({}, radius, {}), std::invalid_argument) << radius;
  }
  EXPECT_THROW(robot.draw_text({}, "", {}), std::invalid_argument);
  EXPECT_THROW(robot.draw_text({}, std::string(101, 'x'), {}), std::invalid_argument);
  for (std::size_t i = 0; i < Robot::max_markers; ++i) robot.draw_ring({}, 1, {});
  EXPECT_THROW(robot.draw_ring({}, 1, {}), std::length_error);
  EXPECT_EQ(one.command().markers_size(), 1000);
  EXPECT_NO_THROW(robot.draw_ring({}, 1, {})) << "the next tick";
}

TEST(ClientMarkers, NeedTheActuator) {
  v1::RobotDescription description = painter();
  description.set_draws_markers(false);
  OneRobot one(description);
  EXPECT_FALSE(one.robot().draws());
  EXPECT_THROW(one.robot().draw_ring({}, 1, {}), std::logic_error);
}

}  // namespace
}  // namespace ziggurat
