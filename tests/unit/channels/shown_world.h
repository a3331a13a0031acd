// SPDX-License-Identifier: MIT
#pragma once
// A small world with one of most devices, and its channels.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "channels/channels.h"
#include "small_scene.h"

namespace ziggurat::channels::testing {

inline simulation::testing::SmallScene equipped_scene() {
  const std::string devices =
      R"(<radios medium="air"><radio id="mouth" anchor="base" position="0,0,0.1" range="2"/></radios>)"
      R"(<leds medium="leds"><led anchor="base" offset="0,0,0.11" color="green"/></leds>)"
      R"(<tags medium="tags"><tag anchor="origin" position="0,0,0.1" orientation="0,0,0" )"
      R"(observable_angle="80" side_length="0.04" payload="7"/></tags>)";
  const std::string arm =
      R"(<prototype id="arm"><body position="1,0,0" orientation="90,0,0"/><links ref="base">)"
      R"(<link id="base" geometry="box" size=".1,.1,.1" mass="1"/>)"
      R"(<link id="tip" geometry="sphere" radius=".02" mass=".1" position="0,0,.2"/></links><joints>)"
      R"(<joint id="hinge" type="revolute" axis="0,0,1"><parent link="base" position="0,0,.2"/>)"
      R"(<child link="tip" position="0,0,0"/></joint></joints><devices>)" +
      devices + R"(</devices><controller config="c"/></prototype>)";
  return {
      R"(<joints implementation="default"><joint id="hinge" mode="velocity" max_impulse="1"/></joints>)"
      R"(<radios implementation="default"/><leds implementation="default" medium="leds"/>)"
      R"(<tags implementation="default"/>)",
      R"(<joints implementation="default"><joint id="hinge" mode="position"/></joints>)"
      R"(<radios implementation="default"/>)"
      R"(<cameras implementation="default"><camera id="eye" anchor="base" position="0,0,0.2" )"
      R"(orientation="0,180,0" range="0.01:9" focal_length="100,100" principle_point="80,60" )"
      R"(resolution="160,120"><tag_detector medium="tags"/><led_detector medium="leds"/>)"
      R"(</camera></cameras>)",
      arm + R"(<box id="crate" size="0.2,0.3,0.4" movable="true" mass="1">)"
            R"(<body position="0,0.5,0"/></box>)"};
}

struct ShownWorld {
  explicit ShownWorld(const simulation::testing::SmallScene& text = equipped_scene())
      : scene(text.read()), simulation(scene, {1}) {
    populate();
  }

  void populate() {
    channels.populate({scene, path, scene_hash, 1, 0, simulation.layout(), simulation.entities(),
                       simulation.state()});
  }
  const Channel* find(const std::string& topic) const {
    for (const Channel& channel : channels.list()) {
      if (channel.topic == topic) return &channel;
    }
    return nullptr;
  }
  std::vector<Message> encode(const std::string& topic) {
    const Channel* channel = find(topic);
    EXPECT_TRUE(channel) << topic;
    std::vector<Message> messages;
    if (!channel) return messages;
    channels.encode({simulation.state(),
                     simulation.observations(),
                     simulation.commands(),
                     simulation.contacts(),
                     {1, 2, 3, 4},
                     simulation.rays()},
                    pace_of(channel->kind), std::vector{channel->id}, messages);
    return messages;
  }
  template <class Type>
  Type read(const std::string& topic) {
    const auto messages = encode(topic);
    Type message;
    EXPECT_EQ(messages.size(), 1u) << topic;
    if (messages.size() != 1) return message;
    EXPECT_EQ(find(topic)->schema->name, message.GetTypeName());
    EXPECT_EQ(messages[0].time_ns, simulation.state().time_ns);
    EXPECT_TRUE(message.ParseFromString(messages[0].content->bytes()));
    return message;
  }

  const std::string path = "small.argos", scene_hash = "0123456789abcdef";
  scene::Scene scene;
  simulation::Simulation simulation;
  Channels channels;
};

}  // namespace ziggurat::channels::testing
