// SPDX-License-Identifier: MIT
// Each hashed field changes the hash, and only those.

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "world/state.h"

namespace ziggurat::world {
namespace {

struct Moment {
  State state;
  Observations observations;
};

/// One of everything.
Moment full() {
  Moment moment;
  State& state = moment.state;
  state.origins.resize(1);
  state.links.resize(1);
  state.led_colors = {1};
  state.directional_led_colors = {2};
  state.tag_payloads = {"tag"};
  state.magnet_fields = {{1, 2, 3}};
  state.range_and_bearing_data = {4};
  Observations& seen = moment.observations;
  seen.joint_readings = {0.5};
  seen.radio_messages.add(0, std::vector<std::uint8_t>{1, 2});
  seen.proximity = {0.25};
  seen.range_and_bearing = {{0, 1, 2, 3, {0, 1}}};
  seen.range_and_bearing_data = {7};
  seen.positioning.resize(1);
  seen.batteries = {{0.5, 3}};
  seen.leds = {{0, 1, {2, 3}}};
  seen.directional_leds = {{0, 1, {2, 3}}};
  seen.tags.resize(1);
  for (auto& corner : seen.tags[0].corners) corner.setZero();
  seen.wheels = {{1, 2, 3, 4}};
  seen.turrets = {0.125};
  seen.contact_sensors = {{1, {2, 3, 4}, 9}};
  seen.imus = {{{1, 2, 3}, {4, 5, 6}}};
  seen.device_readings = {0.375};
  seen.device_rows = {{1, {5}}};
  return moment;
}

TEST(Hash, IsOfEveryChannelAndEveryListOfReadings) {
  const Moment usual = full();
  const std::uint64_t before = hash(usual.state, usual.observations);
  const std::vector<std::function<void(Moment&)>> changes{
      [](Moment& m) { m.state.tick = 1; },
      [](Moment& m) { m.observations.device_readings[0] = 9; },
      [](Moment& m) { m.observations.device_rows[0].values = {}; },
      [](Moment& m) { m.observations.device_rows[0].values[0] = 9; },
      [](Moment& m) { m.state.origins[0].position.x() = 1; },
      [](Moment& m) { m.state.links[0].pose.orientation.w() = 0.5; },
      [](Moment& m) { m.state.links[0].velocity.z() = 1; },
      [](Moment& m) { m.state.links[0].angular_velocity.y() = 1; },
      [](Moment& m) { m.state.absent = {true}; },
      [](Moment& m) { m.state.led_colors[0] = 9; },
      [](Moment& m) { m.state.directional_led_colors[0] = 9; },
      [](Moment& m) { m.state.tag_payloads[0] = "other"; },
      [](Moment& m) { m.state.magnet_fields[0].z() = 9; },
      [](Moment& m) { m.state.range_and_bearing_data[0] = 9; },
      [](Moment& m) { m.observations.joint_readings[0] = 9; },
      [](Moment& m) { m.observations.radio_messages.bytes[1] = 9; },
      [](Moment& m) { m.observations.proximity[0] = 9; },
      [](Moment& m) { m.observations.range_and_bearing[0].vertical_bearing = 9; },
      [](Moment& m) { m.observations.range_and_bearing_data[0] = 9; },
      [](Moment& m) { m.observations.positioning[0].orientation.z() = 9; },
      [](Moment& m) { m.observations.batteries[0].time_left = 9; },
      [](Moment& m) { m.observations.leds[0].color = 9; },
      [](Moment& m) { m.observations.directional_leds[0].center.y() = 9; },
      [](Moment& m) { m.observations.tags[0].corners[3].y() = 9; },
      [](Moment& m) { m.observations.wheels[0].distance_right = 9; },
      [](Moment& m) { m.observations.turrets[0] = 9; },
      [](Moment& m) { m.observations.contact_sensors[0].strength = 7; },
      [](Moment& m) { m.observations.imus[0].angular_velocity[2] = 9; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Moment changed = usual;
    changes[i](changed);
    EXPECT_NE(hash(changed.state, changed.observations), before) << "change " << i;
  }
}

TEST(Hash, IsNotOfWhatOnlyPeopleSee) {
  const Moment usual = full();
  Moment changed = usual;
  changed.state.rays.emplace_back();
  changed.state.frusta.emplace_back();
  changed.observations.images.push_back({0, {1, 2, 3}});
  changed.observations.time_ns = changed.state.time_ns = 5;
  EXPECT_EQ(hash(changed.state, changed.observations), hash(usual.state, usual.observations));
}

}  // namespace
}  // namespace ziggurat::world
