// SPDX-License-Identifier: MIT
// The arena: bodies, trees of joints, devices and distributions.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene_text.h"

namespace ziggurat::scene {
namespace {

Entity read_one(const std::string& element, const std::string& engine_attributes = "") {
  SceneText text;
  text.arena = arena_with(element);
  text.engines =
      "<physics_engines><dynamics3d id=\"d\" " + engine_attributes + "/></physics_engines>";
  text.media = R"(<media><led id="leds"/><tag id="tags"/><radio id="radio"/></media>)";
  const ReadResult result = text.read();
  EXPECT_TRUE(result.ok()) << all_problems(result);
  return result.scene.entities.empty() ? Entity{} : result.scene.entities[0];
}

TEST(Bodies, BoxAndCylinder) {
  const Entity box = read_one(
      R"(<box id="b" size="1,2,3" movable="true" mass="0.25"><body position="1,2,3" orientation="90,0,0"/></box>)");
  EXPECT_EQ(box.kind, EntityKind::box);
  ASSERT_EQ(box.links.size(), 1u);
  EXPECT_EQ(box.links[0].id, "");
  EXPECT_EQ(std::get<Box>(box.links[0].geometry).size, math::Vector3(1, 2, 3));
  EXPECT_EQ(box.links[0].mass, 0.25);
  EXPECT_EQ(box.pose.position, math::Vector3(1, 2, 3));
  EXPECT_NEAR((box.pose.orientation * math::Vector3::UnitX() - math::Vector3::UnitY()).norm(), 0,
              1e-12);
  const Entity cylinder = read_one(
      R"(<cylinder id="c" radius="0.5" height="2" movable="false" mass="10"><body/></cylinder>)");
  EXPECT_EQ(std::get<Cylinder>(cylinder.links[0].geometry).radius, 0.5);
  EXPECT_FALSE(cylinder.movable);
  EXPECT_EQ(cylinder.links[0].mass, 0.0);
}

TEST(Bodies, SurfaceAndDampingDefaults) {
  const std::string box =
      R"(<box id="b" size="1,1,1" movable="false" friction="0.9"><body/></box>)";
  const std::string robot =
      R"(<prototype id="p"><body/><links ref="a"><link id="a" geometry="sphere" radius="1" mass="1" angular_damping="0"/></links></prototype>)";
  const Link single = read_one(box).links[0];
  EXPECT_EQ(single.surface.friction, 0.9);
  EXPECT_EQ(single.surface.rolling_friction, 2e-4);
  EXPECT_EQ(single.damping.linear, 0.0);
  const Link link = read_one(robot).links[0];
  EXPECT_EQ(link.surface.friction, 0.5);
  EXPECT_EQ(link.surface.rolling_friction, 0.0);
  EXPECT_EQ(link.damping.linear, 0.04);
  EXPECT_EQ(link.damping.angular, 0.0);
  // The engine comes after the arena in the document; its defaults still apply.
  const std::string engine =
      R"(friction="0.1" rolling_friction="0.2" linear_damping="0.3" angular_damping="0.4")";
  const Link over = read_one(robot, engine).links[0];
  EXPECT_EQ(over.surface.friction, 0.1);
  EXPECT_EQ(over.surface.rolling_friction, 0.2);
  EXPECT_EQ(over.damping.linear, 0.3);
  EXPECT_EQ(over.damping.angular, 0.0);
  EXPECT_EQ(read_one(box, engine).links[0].surface.friction, 0.9);
  EXPECT_EQ(read_one(box, engine).links[0].surface.rolling_friction, 0.2);
}

TEST(Joints, AreOrderedFromTheRootOutwards) {
  const Entity entity =
      read_one(tree(link("tip") + link("arm") + link("base") + link("other"),
                    joint("j_tip", "arm", "tip") + joint("j_other", "base", "other") +
                        joint("j_arm", "base", "arm")));
  EXPECT_EQ(entity.reference_link, 2u);
  ASSERT_EQ(entity.joints.size(), 3u);
  EXPECT_EQ(entity.joints[0].id, "j_other");
  EXPECT_EQ(entity.joints[1].id, "j_arm");
  EXPECT_EQ(entity.joints[2].id, "j_tip");
  EXPECT_EQ(entity.joints[2].parent, 1u);
  EXPECT_EQ(entity.joints[2].child, 0u);
}

TEST(Joints, AxisLimitAndFrames) {
  const Entity entity = read_one(tree(
      link("base") + link("a") + link("b"),
      joint("r", "base", "a", R"(type="revolute" axis="0,3,0" limit="-90:45")") +
          R"(<joint type="prismatic" axis="1,0,0" limit="-0.1:0.2" disable_collision="true">)"
          R"(<parent link="a" position="1,2,3" orientation="0,0,90"/><child link="b" position="4,5,6"/></joint>)"));
  const Joint& revolute = entity.joints.at(0);
  EXPECT_EQ(revolute.axis, math::Vector3::UnitY());
  EXPECT_DOUBLE_EQ(revolute.limit->lower, -std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(revolute.limit->upper, std::numbers::pi / 4);
  const Joint& prismatic = entity.joints.at(1);
  EXPECT_EQ(prismatic.id, "joint_0");
  EXPECT_EQ(prismatic.limit->upper, 0.2);
  EXPECT_EQ(prismatic.parent_frame.position, math::Vector3(1, 2, 3));
  EXPECT_EQ(prismatic.child_frame.position, math::Vector3(4, 5, 6));
  EXPECT_NEAR(
      (prismatic.parent_frame.orientation * math::Vector3::UnitY() - math::Vector3::UnitZ()).norm(),
      0, 1e-12);
}

std::vector<std::string> tree_faults(const std::string& links, const std::string& joints) {
  SceneText text;
  text.arena = arena_with(tree(links, joints));
  return faults(text.read());
}

TEST(Joints, CyclesAndUnconnectedLinksAreReportedOnceEach) {
  const std::string abc = link("base") + link("a") + link("b") + link("c");
  auto found = tree_faults(abc, joint("1", "a", "b") + joint("2", "b", "c") + joint("3", "c", "a"));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(count_containing(found, "is part of a loop that never meets the reference link"), 1u);
  found = tree_faults(abc, joint("1", "a", "b") + joint("2", "b", "c"));
  ASSERT_EQ(found.size(), 1u);  // only the first unconnected link, not its children
  EXPECT_EQ(count_containing(found, "link \"a\" is not connected"), 1u);
  found = tree_faults(abc, joint("1", "base", "a") + joint("2", "a", "b") + joint("3", "b", "c") +
                               joint("4", "c", "base"));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(count_containing(
                found,
                "joint \"4\" has the reference link \"base\" as its child; links form a tree, in "
                "which no loop of joints can be closed: leave this joint out"),
            1u);
  found = tree_faults(link("base") + link("a"), joint("1", "a", "a"));
  EXPECT_EQ(count_containing(found, "loop"), 1u);
}

/// Four links in a ring, closed by the last joint from either end, and a joint the wrong way round.
TEST(Joints, ALoopIsToldWhatToDoInsteadAndAReversedJointToBeSwapped) {
  const std::string ring = link("base") + link("a") + link("b") + link("c");
  const std::string open = joint("1", "base", "a") + joint("2", "a", "b") + joint("3", "base", "c");
  for (const auto& last : {joint("4", "c", "b"), joint("4", "b", "c")}) {
    const auto found = tree_faults(ring, open + last);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(count_containing(found, "no loop of joints can be closed: leave this joint out"), 1u)
        << found[0];
  }
  EXPECT_TRUE(tree_faults(ring, open).empty());  // the advice
  auto found = tree_faults(link("base") + link("a"), joint("1", "a", "base"));
  EXPECT_EQ(count_containing(found, "as its child; swap its parent and child"), 1u);
  found = tree_faults(ring, joint("1", "base", "a") + joint("2", "a", "b") + joint("3", "c", "b"));
  EXPECT_EQ(
      count_containing(found, "a second parent, after joint \"2\"; swap its parent and child"), 1u);
}

TEST(Links, UnnamedOnesAreNumbered) {
  const Entity entity = read_one(
      R"(<prototype id="p" movable="false"><body/><links ref="link_0"><link geometry="box" size="1,1,1" mass="0"/></links></prototype>)");
  EXPECT_EQ(entity.links[0].id, "link_0");  // fixed to the world: its mass has no effect
}

TEST(DevicesOfAPrototype, IdsAnchorsAndRings) {
  const Entity entity = read_one(tree(
      link("base"), "",
      R"(<devices><magnets><magnet id="m" anchor="origin" offset="0,0,0" passive_field="1,2,3"/>)"
      R"(<magnet anchor="base" offset="1,0,0" passive_field="0,0,0" active_field="4,5,6"/></magnets>)"
      R"(<radios medium="radio"><radio anchor="base" position="0,0,0" range="1" duplex_mode="half"/></radios>)"
      R"(<proximity_sensors range="0.5"><sensor anchor="base" offset="0,0,1" direction="0,2,0" range="0.1"/>)"
      R"(<ring anchor="base" radius="2" num_sensors="4" start_angle="90" center="0,0,3"/></proximity_sensors></devices>)"));
  const Devices& devices = entity.devices;
  ASSERT_EQ(devices.magnets.size(), 2u);
  EXPECT_EQ(devices.magnets[0].anchor.link, Anchor::origin);
  EXPECT_EQ(devices.magnets[1].anchor.link, 0);
  EXPECT_EQ(devices.magnets[1].id, "magnet_0");
  EXPECT_EQ(devices.magnets[1].active_field, math::Vector3(4, 5, 6));
  EXPECT_EQ(devices.radios.at(0).id, "radio_0");
  ASSERT_EQ(devices.proximity_sensors.size(), 5u);
  EXPECT_EQ(devices.proximity_sensors[0].direction, math::Vector3::UnitY());
  const ProximitySensor& second = devices.proximity_sensors[2];  // 180 degrees
  EXPECT_EQ(second.range, 0.5);  // from the container, as beta50 reads it
  EXPECT_NEAR((second.offset - math::Vector3(-2, 0, 3)).norm(), 0, 1e-12);
  EXPECT_NEAR((second.direction + math::Vector3::UnitX()).norm(), 0, 1e-12);
}

// --- distribution -------------------------------------------------------------------------------

TEST(Distribute, MethodsAndPattern) {
  SceneText text;
  text.arena = arena_with(
      R"(<distribute><position method="grid" center="0,0,0" distances="0.05,0.1,0" layout="5,4,1"/>)"
      R"(<orientation method="uniform" min="0,0,0" max="360,0,0"/>)"
      R"(<entity quantity="20" max_trials="100" base_num="7">)"
      R"(<box id="b" size="1,1,1" movable="true" mass="1"><body position="9,9,9"/></box></entity></distribute>)"
      R"(<box id="b6" size="1,1,1" movable="false"><body/></box>)"
      R"(<box id="b27" size="1,1,1" movable="false"><body/></box>)");
  const ReadResult result = text.read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  ASSERT_EQ(result.scene.distributions.size(), 1u);
  const Distribution& distribution = result.scene.distributions[0];
  EXPECT_EQ(distribution.position.method, DistributionMethod::grid);
  EXPECT_EQ(distribution.position.layout, (std::array{5u, 4u, 1u}));
  EXPECT_EQ(distribution.orientation.second, math::Vector3(360, 0, 0));
  EXPECT_EQ(distribution.quantity, 20u);
  EXPECT_EQ(distribution.max_trials, 100u);
  EXPECT_EQ(distribution.base_num, 7u);
  EXPECT_EQ(distribution.entity.id, "b");
  EXPECT_EQ(distribution.entity.pose.position, math::Vector3::Zero());
  EXPECT_EQ(count_containing(notices(result), "position and orientation of a distributed"), 1u);
}

TEST(Distribute, TwoGroupsMustNotCreateTheSameIds) {
  const std::string group = R"(<distribute><position method="constant" values="0,0,0"/>)"
                            R"(<orientation method="constant" values="0,0,0"/>)";
  const std::string body = R"(" size="1,1,1" movable="false"/></entity></distribute>)";
  SceneText text;  // "b1" + "0" is "b" + "10"
  text.arena = arena_with(group + R"(<entity quantity="11" max_trials="0"><box id="b)" + body +
                          group + R"(<entity quantity="1" max_trials="0"><box id="b1)" + body);
  EXPECT_EQ(count_containing(faults(text.read()), "makes a copy called \"b10\""), 1u);
}

TEST(Distribute, LightsAreCountedAsEntities) {
  SceneText text;  // an empty id: no ids of copies are made
  text.arena = arena_with(
      R"(<distribute><position method="constant" values="0,0,0"/>)"
      R"(<orientation method="constant" values="0,0,0"/><entity max_trials="0" quantity="1000000">)"
      R"(<light id="" color="red" intensity="1" medium="leds"/></entity></distribute>)");
  EXPECT_EQ(count_containing(faults(text.read()), "quantity=\"1000000\" of <entity> is too many"),
            1u);
}

TEST(Arena, ALightIsAFrameWithAnLed) {
  SceneText text;
  text.media = R"(<media><led id="leds"/></media>)";
  text.arena =
      arena_with(R"(<light id="l" position="0,0,1" color="yellow" intensity="2" medium="leds"/>)");
  const ReadResult result = text.read();
  EXPECT_TRUE(result.ok()) << all_problems(result);
  ASSERT_EQ(result.scene.entities.size(), 1u);
  const Entity& light = result.scene.entities[0];
  EXPECT_EQ(light.kind, EntityKind::light);
  EXPECT_EQ(light.intensity, 2);
  EXPECT_EQ(light.pose.position, math::Vector3(0, 0, 1));
  ASSERT_EQ(light.links.size(), 1u);
  EXPECT_FALSE(light.links[0].collides || light.movable);
  ASSERT_EQ(light.devices.leds.size(), 1u);
  EXPECT_EQ(light.devices.leds[0].color, (Color{255, 255, 0}));
  EXPECT_EQ(light.devices.led_medium, 0u);
}

TEST(Arena, TheLastFloorCounts) {
  SceneText text;
  text.arena = arena_with(R"(<floor id="f" source="image" path="no.png"/>)"
                          R"(<floor id="g" source="loop_functions"/>)");
  const ReadResult result = text.read();
  EXPECT_TRUE(result.ok()) << all_problems(result);
  EXPECT_EQ(count_containing(notices(result), "a later one replaces it"), 1u);
  EXPECT_EQ(count_containing(notices(result), "<floor source=\"loop_functions\"> is white"), 1u);
  EXPECT_EQ(result.scene.floor_image, nullptr);
}

TEST(Arena, AFloorThatIsNotThereIsWhiteWhenLenient) {
  SceneText text;
  text.arena = arena_with(R"(<floor id="f" source="image" path="no.png"/>)");
  const ReadResult result = text.read({.lenient = true});
  EXPECT_TRUE(result.ok()) << all_problems(result);
  EXPECT_EQ(count_containing(notices(result), "the floor is white"), 1u);
}

TEST(Prototype, ARepeatedLinkIdHidesWhatMayFollowFromIt) {
  SceneText text;
  text.arena = arena_with(
      R"(<prototype id="p"><body/><links ref="a"><link id="a" geometry="sphere" radius="1" mass="1"/>)"
      R"(<link id="a" geometry="sphere" radius="1" mass="1"/>)"
      R"(<link id="b" geometry="sphere" radius="1" mass="1"/></links><joints>)"
      R"(<joint id="j" type="fixed"><parent link="nowhere"/><child link="b"/></joint></joints>)"
      R"(</prototype>)");
  const auto found = faults(text.read());
  ASSERT_EQ(found.size(), 1u) << all_problems(text.read());
  EXPECT_EQ(count_containing(found, "is the id of an earlier link at line 4"), 1u);
}

}  // namespace
}  // namespace ziggurat::scene
