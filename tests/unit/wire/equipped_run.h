// SPDX-License-Identifier: MIT
#pragma once
// A run of robots that carry a different number of each device, for tests that need no scene.

#include <string>
#include <vector>

#include "scene/scene.h"
#include "wire/messages.h"
#include "world/commands.h"
#include "world/layout.h"

namespace ziggurat::wire {

/// Robots "a", "b" and "c". a has everything once, and radios twice; b has nothing. c has
/// everything twice, with one radio that only sends and one that only receives. Everything of c
/// comes after that of a; LED, magnet and tag 1 belong to an entity that is not a robot. a's camera
/// sees LEDs and tags and takes pictures of 2 x 1 pixels. c's first camera sees tags and
/// directional LEDs; its second sees all but takes no pictures. a drives wheels and turret and
/// measures neither; c does both.
class EquippedRun {
 public:
  EquippedRun() {
    controllers_.resize(1);
    layout_.links.push_back({"base", 0});
    layout_.leds.resize(4);
    layout_.directional_leds.resize(3);
    layout_.tags.resize(4);
    layout_.magnets.resize(4);
    layout_.proximity.resize(3);
    layout_.radios.resize(4);
    layout_.positioning = {0, 2};
    layout_.batteries.resize(3);
    layout_.imus.resize(3);
    layout_.contact_sensors = {{"skin0", "base", 0, 0}, {"skin1", "origin", 2, 0}};
    layout_.range_and_bearing.resize(3);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::string number = std::to_string(i);
      layout_.leds[i].id = "led" + number;
      layout_.leds[i].color = 0x010203 * static_cast<world::Color>(i);
      layout_.tags[i].id = "tag" + number;
      layout_.tags[i].payload = "payload" + number;
      layout_.magnets[i].id = "magnet" + number;
      layout_.radios[i].id = "radio" + number;
      layout_.radios[i].range = 0.5;
      layout_.radios[i].sends = i != 3;
      layout_.radios[i].receives = i != 2;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      layout_.imus[i].id = "imu" + std::to_string(i);
      layout_.directional_leds[i].id = "directional" + std::to_string(i);
      layout_.range_and_bearing[i] = {
          .mount = {}, .range = 3.0, .data = {4 * i, 4}, .sends = i != 1, .receives = true};
      layout_.proximity[i].range = 0.1 * static_cast<double>(i + 1);
    }
    layout_.proximity[0].mount.link = 0;
    layout_.imus[2].mount = {0, 0, {{1, 2, 3}, math::Quaternion(0, 0, 1, 0)}};
    layout_.proximity[1].angle = -2.5;
    add_cameras();
    layout_.wheels = {{.entity = 0, .axle_length = 0.14, .drives = true},
                      {.entity = 1, .axle_length = 0.1, .measures = true},
                      {.entity = 2, .axle_length = 0.053, .drives = true, .measures = true}};
    layout_.turrets = {{.entity = 0, .drives = true},
                       {.entity = 2, .drives = true, .measures = true}};
    world::RobotLayout a, b, c;
    a.id = "a", b.id = "b", c.id = "c";
    a.radios = {0, 2}, c.radios = {2, 2};
    a.leds = {0, 1}, c.leds = {2, 2};
    a.directional_leds = {0, 1}, c.directional_leds = {1, 2};
    a.tags = {0, 1}, c.tags = {2, 2};
    a.magnets = {0, 1}, c.magnets = {2, 2};
    a.proximity = {0, 1}, c.proximity = {1, 2};
    a.range_and_bearing = {0, 1}, c.range_and_bearing = {2, 1};
    a.positioning = {0, 1}, c.positioning = {1, 1};
    a.batteries = {0, 1}, c.batteries = {2, 1};
    a.imus = {0, 1}, c.imus = {1, 2};
    a.contact_sensors = {0, 1}, c.contact_sensors = {1, 1};
    a.cameras = {0, 1}, c.cameras = {1, 2};
    a.wheels = {0, 1}, c.wheels = {2, 1};
    a.turrets = {0, 1}, c.turrets = {1, 1};
    layout_.robots = {a, b, c};
  }

  const world::Layout& layout() const { return layout_; }
  Run run() const {
    return {layout_, controllers_, {}, 42, 100'000'000, 10, "0123456789abcdef", "0.1.0"};
  }

  /// As the scene says.
  world::Commands commands() const {
    world::Commands commands;
    for (const auto& led : layout_.leds) commands.led_colors.push_back(led.color);
    commands.directional_led_colors.resize(3);
    for (const auto& tag : layout_.tags) commands.tag_payloads.push_back(tag.payload);
    commands.magnet_currents.resize(4);
    commands.range_and_bearing_data.resize(12);
    commands.wheels.resize(3);
    commands.turret_modes.resize(2);
    commands.turret_rotations.resize(2);
    commands.turret_speeds.resize(2);
    return commands;
  }

  /// Zeros of the right size.
  world::Observations observations() const {
    world::Observations observations;
    observations.proximity.resize(3);
    observations.positioning.resize(2);
    observations.batteries.resize(3);
    observations.imus.resize(3);
    observations.contact_sensors.resize(2);
    observations.wheels.resize(3);
    observations.turrets.resize(2);
    return observations;
  }

 private:
  void add_cameras() {
    layout_.cameras.resize(3);
    for (std::size_t i = 0; i < 3; ++i) {
      world::CameraLayout& camera = layout_.cameras[i];
      camera.id = "camera" + std::to_string(i);
      camera.tags.emplace();
      if (i != 1) camera.leds.emplace();
      if (i != 0) camera.directional_leds.emplace();
    }
    world::CameraLayout& first = layout_.cameras[0];
    first.mount = {0, 0, {{1, 2, 3}, math::Quaternion(0.5, -0.5, 0.5, -0.5)}};
    first.near = 0.1;
    first.far = 2;
    first.focal_length = {800, 900};
    first.principal_point = {320, 240};
    first.resolution = {2, 1};
    first.image = true;
  }

  world::Layout layout_;
  std::vector<scene::Controller> controllers_;
};

}  // namespace ziggurat::wire
