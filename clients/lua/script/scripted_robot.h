#pragma once
// A robot as its script sees it: plain values. Whoever runs the script writes what is sensed
// before a call and takes what was commanded and logged after it; no network in here.

#include <string>
#include <utility>
#include <vector>

#include "script/log_lines.h"

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
  LogLines log;
};

}  // namespace ziggurat::lua
