#pragma once
// Camera readings for a line of `--readings`.

#include <cstddef>
#include <string>

#include "outputs/reading.h"

namespace ziggurat::outputs {

using CameraMap = google::protobuf::Map<std::string, v1::CameraReading>;

/// The robot that a camera belongs to.
/// @param camera  into Layout::cameras
const world::RobotLayout& robot_with(std::size_t camera, const world::Layout& layout);

/// Adds an entry for each camera of the robot, also for those that see nothing.
void add_cameras(const Moment& moment, const world::RobotLayout& robot, CameraMap& out);

}  // namespace ziggurat::outputs
