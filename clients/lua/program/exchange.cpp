#include "program/exchange.h"

#include <stdexcept>

namespace ziggurat::lua {

ScriptedRobot describe(ziggurat::Robot& robot) {
  ScriptedRobot scripted;
  scripted.id = robot.id();
  scripted.params = robot.params();
  for (const ziggurat::Joint& from : robot.joints()) {
    Joint& joint = scripted.joints.emplace_back();
    joint.id = from.id();
    joint.has_encoder = from.has_encoder();
    joint.has_motor = from.has_motor();
  }
  return scripted;
}

void sense(ziggurat::Robot& from, ScriptedRobot& to) {
  auto joint = to.joints.begin();
  for (const ziggurat::Joint& sensed : from.joints()) (joint++)->encoder = sensed.encoder();
}

void act(ScriptedRobot& from, ziggurat::Robot& to) {
  auto commanded = to.joints().begin();
  for (Joint& joint : from.joints) {
    if (joint.is_target_fresh) commanded->set_target(joint.target);
    joint.is_target_fresh = false;
    ++commanded;
  }
}

bool hand_over_log(ScriptedRobot& from, ziggurat::Robot& to) {
  bool fits = true;
  try {
    for (const LogLine& line : from.log.lines) {
      if (line.is_error) {
        to.log_error(line.text);
      } else {
        to.log(line.text);
      }
    }
  } catch (const std::length_error&) {
    fits = false;
  }
  from.log.clear();
  return fits;
}

}  // namespace ziggurat::lua
