// SPDX-License-Identifier: MIT
// <block> is the block of scenes/models/block.argos, part by part.

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "checkout/checkout.h"
#include "scene/scene_text.h"

namespace ziggurat::scene {
namespace {

SceneText with(const std::string& entities) {
  SceneText text;
  text.arena = arena_with(entities);
  text.media = R"(<media><directional_led id="directional_leds"/><tag id="tags"/><led id="leds"/>)"
               R"(<radio id="nfc"/></media>)";
  return text;
}

/// The links, joints and devices of the model.
std::string parts_of_model() {
  std::ifstream file(checkout() / "scenes/models/block.argos");
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const std::string end = "</devices>";
  const std::size_t from = text.find("<links"), to = text.find(end);
  return text.substr(from, to + end.size() - from);
}

void expect_equal(const math::Pose& a, const math::Pose& b, const std::string& what) {
  EXPECT_LT((a.position - b.position).norm(), 1e-12) << what;
  EXPECT_LT(a.orientation.angularDistance(b.orientation), 1e-6) << what;
}

TEST(Block, ShowsTheColourThatItsElementHas) {
  const ReadResult result = with(R"(<block id="b" init_led_color="orange"><body/></block>)").read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  const Devices& devices = result.scene.entities.at(0).devices;
  ASSERT_FALSE(devices.directional_leds.empty());
  for (const DirectionalLed& led : devices.directional_leds) EXPECT_EQ(led.color.red, 255);
}

TEST(Block, HasThePartsOfItsModel) {
  const ReadResult result =
      with(R"(<prototype id="m"><body/>)" + parts_of_model() + R"(</prototype>)" +
           R"(<block id="b"><body position="1,0,0"/></block>)")
          .read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  const Entity &model = result.scene.entities.at(0), &block = result.scene.entities.at(1);
  EXPECT_EQ(block.kind, EntityKind::prototype);
  ASSERT_EQ(block.links.size(), model.links.size());
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    EXPECT_EQ(block.links[i].id, model.links[i].id);
    EXPECT_EQ(block.links[i].mass, model.links[i].mass);
    EXPECT_EQ(block.links[i].geometry.index(), model.links[i].geometry.index());
  }
  ASSERT_EQ(block.joints.size(), model.joints.size());
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const Joint &a = block.joints[i], &b = model.joints[i];
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.child, b.child);
    EXPECT_EQ(a.type, b.type);
    expect_equal(a.parent_frame, b.parent_frame, a.id);
    expect_equal(a.child_frame, b.child_frame, a.id);
  }
}

TEST(Block, HasTheDevicesOfItsModel) {
  const ReadResult result =
      with(R"(<prototype id="m"><body/>)" + parts_of_model() + R"(</prototype>)" +
           R"(<block id="b"><body position="1,0,0"/></block>)")
          .read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  const Devices &a = result.scene.entities.at(1).devices, &b = result.scene.entities.at(0).devices;
  ASSERT_EQ(a.magnets.size(), b.magnets.size());
  for (std::size_t i = 0; i < b.magnets.size(); ++i) {
    EXPECT_EQ(a.magnets[i].anchor.link, b.magnets[i].anchor.link);
    EXPECT_EQ(a.magnets[i].offset, b.magnets[i].offset);
    EXPECT_EQ(a.magnets[i].passive_field, b.magnets[i].passive_field);
  }
  ASSERT_EQ(a.radios.size(), b.radios.size());
  ASSERT_EQ(a.tags.size(), b.tags.size());
  for (std::size_t i = 0; i < b.tags.size(); ++i) {
    EXPECT_LT((a.radios[i].position - b.radios[i].position).norm(), 1e-12);
    EXPECT_EQ(a.radios[i].range, b.radios[i].range);
    expect_equal(a.tags[i].pose, b.tags[i].pose, a.tags[i].payload);
    EXPECT_EQ(a.tags[i].payload, b.tags[i].payload);
    EXPECT_NEAR(a.tags[i].observable_angle, b.tags[i].observable_angle, 1e-12);
    EXPECT_EQ(a.tags[i].side_length, b.tags[i].side_length);
  }
  ASSERT_EQ(a.directional_leds.size(), b.directional_leds.size());
  for (std::size_t i = 0; i < b.directional_leds.size(); ++i) {
    expect_equal(a.directional_leds[i].pose, b.directional_leds[i].pose, std::to_string(i));
    EXPECT_NEAR(a.directional_leds[i].observable_angle, b.directional_leds[i].observable_angle,
                1e-12);
  }
  EXPECT_EQ(a.tag_medium, b.tag_medium);
  EXPECT_EQ(a.radio_medium, b.radio_medium);
  EXPECT_EQ(a.directional_led_medium, b.directional_led_medium);
}

TEST(Block, LeavesOutDevicesWithoutMedium) {
  SceneText text = with(R"(<block id="b"><body/></block>)");
  text.media = R"(<media><led id="leds"/></media>)";
  const ReadResult result = text.read();
  ASSERT_TRUE(result.ok()) << all_problems(result);
  const Devices& devices = result.scene.entities.at(0).devices;
  EXPECT_TRUE(devices.tags.empty() && devices.radios.empty() && devices.directional_leds.empty());
  EXPECT_EQ(devices.magnets.size(), 8u);
}

}  // namespace
}  // namespace ziggurat::scene
