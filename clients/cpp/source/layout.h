// SPDX-License-Identifier: MIT
#pragma once
// Makes the devices of a session's robots from Welcome: one function per kind of device, each in
// its own file in devices/.

#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "channel.h"
#include "convert.h"
#include "ziggurat/robot.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat {

struct Layout {
  const v1::Welcome& welcome;
  std::vector<Robot>& robots;  ///< as many as in Welcome, in its order; they stay where they are
  Channels& channels;

  // A new kind is one line here, and its function in devices/.
  void add_all() {
    add_batteries();
    add_cameras();
    add_contact_sensors();
    add_described();
    add_imus();
    add_joints();
    add_leds();
    add_magnets();
    add_markers();
    add_positioning();
    add_proximity_sensors();
    add_radios();
    add_range_and_bearing();
    add_tags();
    add_turrets();
    add_wheels();
  }

 private:
  void add_batteries();
  void add_cameras();
  void add_contact_sensors();
  void add_described();
  void add_imus();
  void add_joints();
  void add_leds();
  void add_magnets();
  void add_markers();
  void add_positioning();
  void add_proximity_sensors();
  void add_radios();
  void add_range_and_bearing();
  void add_tags();
  void add_turrets();
  void add_wheels();

  /// Calls function(description, robot) for each robot.
  template <typename Function>
  void each_robot(Function function) {
    int position = 0;
    for (Robot& robot : robots) function(welcome.robots(position++), robot);
  }
  template <typename T>
  T& add(T channel) {
    auto added = std::make_unique<T>(std::move(channel));
    T& reference = *added;
    channels.push_back(std::move(added));
    return reference;
  }
};

/// @param what  and `id`, if any: whose value it is, for the message
/// @throws std::invalid_argument if the value is not finite
void check_finite(double value, std::string_view what, std::string_view id = {});

/// @throws std::logic_error if the robot has no actuator for its `device`
void check_drives(bool drives, const char* device);

}  // namespace ziggurat
