#pragma once
// A robot as its script sees it: plain values. Whoever runs the script writes what is sensed
// before a call and takes what was commanded and logged after it; no network in here.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "script/log_lines.h"
#include "script/scripted_devices.h"

namespace ziggurat::lua {

/// robot.joints.<id>; encoder and motor of the same joint share one.
struct Joint {
  std::string id;

  bool has_encoder = false;
  double encoder = 0;  ///< [m] or [rad] in position mode, [m/s] or [rad/s] in velocity mode

  bool has_motor = false;
  double target = 0;             ///< the last one set; units as for the encoder
  bool is_target_fresh = false;  ///< set since somebody put this to false
};

struct ScriptedRobot {
  std::string id;
  std::vector<std::pair<std::string, std::string>> params;  ///< attributes of <params>
  std::vector<Joint> joints;                                ///< ids are unique

  // Devices that the controller has no sensor or actuator for are not there.
  RadioLimits radio_limits;
  std::vector<Radio> radios;         ///< ids are unique
  std::vector<Setting<Color>> leds;  ///< all in scene order
  std::vector<Setting<Color>> directional_leds;
  std::vector<Setting<std::string>> tags;  ///< payloads, any bytes
  std::vector<Magnet> magnets;             ///< ids are unique
  std::vector<double> proximity;           ///< readings in [0, 1]
  std::vector<double> proximity_angles;    ///< of sensors that tell it, one each [rad]; else empty
  std::optional<Positioning> positioning;
  std::optional<RangeAndBearing> range_and_bearing;
  std::optional<Battery> battery;
  std::vector<Camera> cameras;  ///< ids are unique
  std::optional<Wheels> wheels;
  std::optional<Turret> turret;
  LogLines log;
};

}  // namespace ziggurat::lua
