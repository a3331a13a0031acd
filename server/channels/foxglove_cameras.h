#pragma once
// Cameras in Foxglove's messages.

#include "channels/message.h"
#include "channels/moment.h"
#include "foxglove/schemas.pb.h"
#include "ziggurat/v1/channels.pb.h"

namespace ziggurat::channels {

/// @param camera  into World.cameras
foxglove::CameraCalibration calibration_of(const v1::World& world, std::size_t camera,
                                           std::int64_t time_ns);

/// Detections of the camera: outlines of tags with their payloads, circles about LEDs.
foxglove::ImageAnnotations annotations_of(std::size_t camera, const Moment& moment);

/// The picture that a camera took, encoded when it is asked for; null: it has taken none.
std::shared_ptr<const Content> picture_of(const v1::World& world, std::size_t camera,
                                          const Moment& moment);

}  // namespace ziggurat::channels
