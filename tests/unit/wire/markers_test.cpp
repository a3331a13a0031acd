// SPDX-License-Identifier: MIT
// Markers on the wire: what a command may draw, and the sentences about what it may not.

#include <functional>

#include "wire/command.h"
#include "wire/device_wire.h"

namespace ziggurat::wire {
namespace {

using Shape = world::Marker::Shape;

/// Robots a and c of an EquippedRun draw, b does not.
struct Markers : DeviceWire {
  Markers() : layout(run.layout()) {
    layout.robots[0].draws_markers = layout.robots[2].draws_markers = true;
  }

  /// A marker in the origin, without shape.
  v1::Marker& draw(std::uint32_t robot) {
    v1::Marker& marker = *command->add_markers();
    marker.set_robot(robot);
    for (int i = 0; i < 3; ++i) marker.add_at(0);
    return marker;
  }
  void ring(std::uint32_t robot) { draw(robot).set_radius(1); }
  void arrow(std::uint32_t robot, double z) {
    v1::Marker& marker = draw(robot);
    for (const double value : {1.0, 2.0, z}) marker.add_to(value);
  }

  std::optional<Fault> send() {
    EXPECT_EQ(inbox.parse(message.SerializeAsString()), Inbox::Kind::command);
    auto fault = inbox.check(roster, layout);
    if (!fault) inbox.apply(roster, commands);
    command->Clear();
    return fault;
  }
  void expect_refusal(ErrorCode code, const std::string& robot, const std::string& words) {
    const auto fault = send();
    ASSERT_TRUE(fault) << words;
    EXPECT_EQ(fault->code, code);
    EXPECT_EQ(fault->severity, Severity::discard);
    EXPECT_EQ(fault->field, "markers");
    EXPECT_EQ(fault->robot, robot);
    EXPECT_NE(fault->message.find(words), std::string::npos) << fault->message;
    EXPECT_TRUE(commands.markers.empty());
  }

  world::Layout layout;
};

TEST_F(Markers, AreReadAndWritten) {
  arrow(2, 3);
  ring(0);
  draw(2).set_text(std::string(100, 'x'));
  command->mutable_markers(2)->set_color(0xFFFFFF);
  EXPECT_FALSE(send());
  ASSERT_EQ(commands.markers.size(), 3U);
  EXPECT_EQ(commands.markers[0].robot, 2U);
  EXPECT_EQ(commands.markers[0].shape, Shape::arrow);
  EXPECT_EQ(commands.markers[0].to, math::Vector3(1, 2, 3));
  EXPECT_EQ(commands.markers[1].robot, 0U);
  EXPECT_EQ(commands.markers[1].shape, Shape::ring);
  EXPECT_EQ(commands.markers[1].radius, 1);
  EXPECT_EQ(commands.markers[2].shape, Shape::text);
  EXPECT_EQ(commands.markers[2].color, 0xFFFFFFU);
  v1::Marker written;
  write(commands.markers[0], 7, written);
  EXPECT_EQ(written.robot(), 7U);
  EXPECT_EQ(written.to(2), 3);
  EXPECT_EQ(written.radius(), 0);
  EXPECT_EQ(written.text(), "");
}

TEST_F(Markers, HaveAPlaceAndOneShapeWithinBounds) {
  const std::function<void()> bad[] = {
      [&] { draw(0); },
      [&] { draw(0).add_to(1); },
      [&] { arrow(0, nan); },
      [&] { arrow(0, -1.001e6); },
      [&] { draw(0).set_radius(-1); },
      [&] { draw(0).set_radius(nan); },
      [&] { draw(0).set_radius(1.001e6); },
      [&] { draw(0).set_text(std::string(101, 'x')); },
      [&] { ring(0), command->mutable_markers(0)->set_text("two shapes"); },
      [&] { ring(0), command->mutable_markers(0)->add_at(0); },
      [&] { ring(0), command->mutable_markers(0)->clear_at(); },
      [&] { ring(0), command->mutable_markers(0)->set_at(2, nan); },
      [&] { ring(0), command->mutable_markers(0)->set_color(0x1000000); },
  };
  for (std::size_t i = 0; i < std::size(bad); ++i) {
    SCOPED_TRACE(i);
    bad[i]();
    ring(2);  // nothing of the command has an effect
    expect_refusal(ErrorCode::bad_value, "a", "and one of: `to` of three such numbers");
  }
}

TEST_F(Markers, AreAtMostAThousandOfARobot) {
  for (int i = 0; i < 1000; ++i) ring(0), ring(2);
  EXPECT_FALSE(send());
  EXPECT_EQ(commands.markers.size(), 2000U);
  commands.markers.clear();
  for (int i = 0; i < 1001; ++i) ring(2);
  expect_refusal(ErrorCode::too_many, "c", "draws more than 1000 markers at this tick");
}

TEST_F(Markers, AreOfRobotsThatDrawAndThatTheCommandSpeaksFor) {
  ring(1);
  expect_refusal(ErrorCode::unknown_device, "b", "has no actuator 'debug'");
  command->add_robots(2);
  ring(0);
  expect_refusal(ErrorCode::not_yours, "a", "this command does not speak for");
  command->add_robots(0);
  ring(0);
  EXPECT_FALSE(send());
}

TEST_F(Markers, OfAnAnswerThatIsSentAgainAreForgotten) {
  ring(0), ring(2);
  EXPECT_FALSE(send());
  const Roster other = make_roster(layout, std::vector<std::size_t>{0});
  forget_markers(other, commands.markers);
  ASSERT_EQ(commands.markers.size(), 1U);
  EXPECT_EQ(commands.markers[0].robot, 2U);
}

}  // namespace
}  // namespace ziggurat::wire
