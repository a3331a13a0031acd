#pragma once
// What a server says of robots that have every device, and of what they sense.

#include <cstdint>
#include <string>

#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat {

/// Robots "a" without devices and "b", "c" with everything; b's radio "mouth" only sends.
inline v1::ServerMessage welcome() {
  v1::ServerMessage message;
  v1::Welcome& welcome = *message.mutable_welcome();
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
    robot.mutable_range_and_bearing()->set_range(3);
    robot.mutable_range_and_bearing()->set_data_size(2);
    robot.mutable_range_and_bearing()->set_sends(true);
    robot.mutable_range_and_bearing()->set_receives(true);
    robot.set_positioning(true);
    robot.set_battery(true);
  }
  return message;
}

/// Of two robots with everything.
inline v1::ServerMessage observation(std::uint64_t tick) {
  v1::ServerMessage message;
  v1::Observation& observation = *message.mutable_observation();
  observation.set_tick(tick);
  for (const double reading : {0.25, 0.75}) observation.add_proximity(reading);
  for (int i = 0; i < 14; ++i) observation.add_positioning(i);
  for (const double value : {1.0, 100.0, 0.5, 50.0}) observation.add_batteries(value);
  return message;
}

inline void hear(v1::ServerMessage& message, std::uint32_t radio, const std::string& payload) {
  v1::RadioMessage& heard = *message.mutable_observation()->add_radio_messages();
  heard.set_radio(radio);
  heard.set_payload(payload);
}

}  // namespace ziggurat
