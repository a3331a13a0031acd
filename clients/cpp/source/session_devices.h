#pragma once
// The values of a session's devices other than joints, packed over all its robots, and the
// handles that lead to them.

#include <cstdint>
#include <string>
#include <vector>

#include "radio_traffic.h"
#include "session_cameras.h"
#include "session_driving.h"
#include "settings.h"
#include "ziggurat/session.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat {

/// Built once, from Welcome; then the handles of the robots point into it.
struct Session::Devices {
  /// Makes the handles of `robots`, which stand in Welcome's order and stay where they are.
  Devices(const v1::Welcome& welcome, std::vector<Robot>& robots);
  Devices(const Devices&) = delete;
  Devices& operator=(const Devices&) = delete;

  /// The message stays unchanged until the next is read: readings point into it.
  /// @throws std::runtime_error, saying what, if it is not what was announced; nothing is read
  void read(const v1::Observation& observation);
  /// Adds what was set since the last call.
  void write(v1::Command& command);
  /// After the command was sent.
  void sent(v1::Command& command);
  /// Everything is sent again with the next command: some was not taken.
  void repeat();
  /// What was set becomes what it was in the beginning.
  void reset();

  Radio::Traffic traffic;

 private:
  void count(const v1::Welcome& welcome);
  void add_radios(const v1::RobotDescription& description, Robot& robot);
  void add_range_and_bearing(const v1::RangeAndBearingDescription& description, Robot& robot);
  void add_settings(const v1::RobotDescription& description, Robot& robot);
  void add_sensors(const v1::RobotDescription& description, Robot& robot);
  void check(const v1::Observation& observation) const;
  void read_radio_messages(const v1::Observation& observation);
  void read_packets(const v1::Observation& observation);

  std::vector<Robot>& robots_;
  Settings<std::uint32_t> led_colors_;
  Settings<std::uint32_t> directional_led_colors_;
  Settings<std::string> tag_payloads_;
  Settings<double> magnet_currents_;
  Settings<std::uint8_t> range_and_bearing_data_;
  std::vector<double> proximity_;
  std::vector<Radio*> radios_;
  std::vector<Positioning*> positioning_;
  std::vector<Battery*> batteries_;
  Cameras cameras_;
  Driving driving_;

  // While handles are made: how many have been, over the robots before.
  struct Cursors {
    std::size_t leds = 0, directional_leds = 0, tags = 0, magnets = 0, data = 0, proximity = 0;
  } made_;
};

}  // namespace ziggurat
