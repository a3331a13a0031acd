#pragma once
// What cameras see, for a line of `--readings`.

#include <string>

#include "recording/reading.h"

namespace ziggurat::recording {

using CameraMap = google::protobuf::Map<std::string, v1::CameraReading>;

/// Adds an entry for each camera of the robot, also for those that see nothing.
void add_cameras(const Moment& moment, const world::RobotLayout& robot, CameraMap& out);

}  // namespace ziggurat::recording
