// SPDX-License-Identifier: MIT
#pragma once
// The world in Foxglove's messages: shapes locked to frames, the frames' poses, and cameras.

#include <string>
#include <vector>

#include "channels/message.h"
#include "channels/moment.h"
#include "channels/packing.h"
#include "foxglove/schemas.pb.h"
#include "ziggurat/v1/channels.pb.h"

namespace ziggurat::channels {

void set_time(std::int64_t time_ns, google::protobuf::Timestamp& to);
foxglove::Color color_of(std::uint32_t rgb, double alpha = 1);

/// The frame of a camera: `ENTITY/cameras/CAMERA`.
std::string camera_frame(const v1::World& world, const v1::World::Camera& camera);

/// All shapes; a viewer forgets those that it had.
foxglove::SceneUpdate scene_update(const v1::World& world, const Layers& layers,
                                   std::int64_t time_ns);

/// One transform for each link, then for each camera; fill() sets the poses of the links.
foxglove::FrameTransforms frames_of(const v1::World& world);

/// @param to  made by frames_of() of the same population
void fill(const Moment& from, foxglove::FrameTransforms& to);

/// @param camera  into World.cameras
foxglove::CameraCalibration calibration_of(const v1::World& world, std::size_t camera,
                                           std::int64_t time_ns);

/// Detections of the camera: outlines of tags with their payloads, circles about LEDs.
foxglove::ImageAnnotations annotations_of(std::size_t camera, const Moment& moment);

/// The picture that a camera took, encoded when it is asked for; null: it has taken none.
std::shared_ptr<const Content> picture_of(const v1::World& world, std::size_t camera,
                                          const Moment& moment);

}  // namespace ziggurat::channels
