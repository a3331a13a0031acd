#pragma once
// Between a robot of the session and the same robot as its script sees it.

#include "script/controller.h"
#include "script/scripted_robot.h"
#include "ziggurat/robot.h"

namespace ziggurat::lua {

/// Id, params and devices; the devices stand in the same order as the session's.
ScriptedRobot describe(ziggurat::Robot& robot);

/// Takes over what the robot senses at the session's tick.
void sense(ziggurat::Robot& from, ScriptedRobot& to);

/// Hands over what was commanded since the last call. Fails if the session can't hold any more
/// radio messages at this tick; the robot's other commands are handed over.
Failure act(ScriptedRobot& from, ziggurat::Robot& to);

/// Hands over the lines logged since the last call. False if the session holds no more of them
/// at this tick; the rest is dropped.
bool hand_over_log(ScriptedRobot& from, ziggurat::Robot& to);

}  // namespace ziggurat::lua
