// SPDX-License-Identifier: MIT
#pragma once
// Messages about robots with every device: a Welcome, and observations.

#include <cstdint>
#include <string>

#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat {

/// A camera "eye" of 2 x 1 pixels with all detectors, and "lens", which sees tags only.
inline void add_cameras(v1::RobotDescription& robot) {
  v1::CameraDescription& eye = *robot.add_cameras();
  eye.set_id("eye");
  eye.set_anchor("turret");
  for (const double value : {1.0, 2.0, 3.0}) eye.add_position(value);
  for (const double value : {0.5, -0.5, 0.5, -0.5}) eye.add_orientation(value);
  eye.set_near(0.1);
  eye.set_far(2);
  for (const double value : {800.0, 900.0}) eye.add_focal_length(value);
  for (const double value : {320.0, 240.0}) eye.add_principal_point(value);
  eye.set_width(2);
  eye.set_height(1);
  eye.set_detects_leds(true);
  eye.set_detects_directional_leds(true);
  eye.set_detects_tags(true);
  eye.set_image(true);
  v1::CameraDescription& lens = *robot.add_cameras();
  lens.set_id("lens");
  lens.set_anchor("origin");
  lens.set_detects_tags(true);
}

/// Robots "a" without devices and "b", "c" with all devices; the radio "mouth" only sends.
inline v1::ServerMessage welcome() {
  v1::ServerMessage message;
  v1::Welcome& welcome = *message.mutable_welcome();
  welcome.mutable_version()->set_major(1);
  welcome.set_max_message_bytes(8 << 20);
  welcome.add_robots()->set_id("a");
  for (const char* id : {"b", "c"}) {
    v1::RobotDescription& robot = *welcome.add_robots();
    robot.set_id(id);
    v1::RadioDescription& ears = *robot.add_radios();
    ears.set_id("ears");
    ears.set_range(0.5);
    ears.set_receives(true);
    v1::RadioDescription& mouth = *robot.add_radios();
    mouth.set_id("mouth");
    mouth.set_sends(true);
    robot.add_leds()->set_id("front");
    robot.add_leds()->set_id("rear");
    robot.mutable_leds(1)->set_color(0x010203);
    robot.add_directional_leds()->set_id("beam");
    robot.add_tags()->set_id("tag_0");
    robot.mutable_tags(0)->set_payload("start");
    robot.add_magnets()->set_id("magnet_0");
    v1::ProximityDescription& ray = *robot.add_proximity_sensors();
    ray.set_anchor("base");
    for (const double value : {1.0, 2.0, 3.0}) ray.add_position(value);
    for (const double value : {0.0, 0.0, 1.0}) ray.add_direction(value);
    ray.set_range(0.25);
    if (robot.id() == "c") ray.set_angle(-0.5);
    robot.mutable_range_and_bearing()->set_range(3);
    robot.mutable_range_and_bearing()->set_data_size(2);
    robot.mutable_range_and_bearing()->set_sends(true);
    robot.mutable_range_and_bearing()->set_receives(true);
    robot.set_positioning(true);
    robot.set_battery(true);
    v1::ImuDescription& imu = *robot.add_imus();
    imu.set_id("imu");
    imu.set_anchor("base");
    for (const double value : {1.0, 2.0, 3.0}) imu.add_position(value);
    for (const double value : {0.0, 1.0, 0.0, 0.0}) imu.add_orientation(value);
    robot.add_contact_sensors()->set_id("skin");
    add_cameras(robot);
    robot.mutable_wheels()->set_axle_length(0.14);
    robot.mutable_wheels()->set_drives(true);
    robot.mutable_wheels()->set_measures(true);
    robot.mutable_turret()->set_drives(true);
    robot.mutable_turret()->set_measures(true);
  }
  return message;
}

/// Observation for the robots of welcome(); their cameras see nothing.
inline v1::ServerMessage observation(std::uint64_t tick) {
  v1::ServerMessage message;
  v1::Observation& observation = *message.mutable_observation();
  observation.set_tick(tick);
  for (const double reading : {0.25, 0.75}) observation.add_proximity(reading);
  for (int i = 0; i < 14; ++i) observation.add_positioning(i);
  for (const double value : {1.0, 100.0, 0.5, 50.0}) observation.add_batteries(value);
  for (int i = 0; i < 2; ++i) {
    observation.add_led_counts(0);
    observation.add_directional_led_counts(0);
    observation.add_camera_images();
  }
  for (int i = 0; i < 4; ++i) observation.add_tag_counts(0);
  for (int i = 0; i < 8; ++i) observation.add_wheels(0.01 * i);
  for (const double value : {0.5, -3.0}) observation.add_turret_rotations(value);
  for (int i = 0; i < 12; ++i) observation.add_imus(0.5 * i);
  for (const double value : {0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 9.0}) {
    observation.add_contact_sensors(value);
  }
  return message;
}

/// Appends to the lists; the caller sets the counts.
inline void add_led(v1::Observation& observation, std::uint32_t color, double u, double v) {
  observation.add_led_colors(color);
  observation.add_led_centers(u);
  observation.add_led_centers(v);
}

inline void add_directional_led(v1::Observation& observation, std::uint32_t color, double u,
                                double v) {
  observation.add_directional_led_colors(color);
  observation.add_directional_led_centers(u);
  observation.add_directional_led_centers(v);
}

/// Its corners are at (first, first + 1), (first + 2, first + 3) …
inline void add_tag(v1::Observation& observation, const std::string& payload, double u, double v,
                    double first) {
  observation.add_tag_payloads(payload);
  observation.add_tag_centers(u);
  observation.add_tag_centers(v);
  for (int i = 0; i < 8; ++i) observation.add_tag_corners(first + i);
}

inline void receive(v1::ServerMessage& message, std::uint32_t radio, const std::string& payload) {
  v1::RadioMessage& received = *message.mutable_observation()->add_radio_messages();
  received.set_radio(radio);
  received.set_payload(payload);
}

}  // namespace ziggurat
