// SPDX-License-Identifier: MIT
#pragma once
// The message Poses: where everything is at a tick.

#include <vector>

#include "channels/moment.h"
#include "channels/packing.h"
#include "ziggurat/v1/channels.pb.h"

namespace ziggurat::channels {

/// Parts of a population that its poses are written from.
struct PoseSource {
  struct Joint {
    const scene::Joint* joint;  ///< of Population::entities
    std::size_t parent, child;  ///< into State::links
  };
  /// Adds up to a moment in the frame of the magnet's link: own + dialect * turn * field.
  struct Magnet {
    /// From the anchor's frame to the link's.
    math::Quaternion turn = math::Quaternion::Identity();
    math::Vector3 own = math::Vector3::Zero();  ///< that of its remanence and moment [A m^2]
  };
  std::vector<Joint> joints;
  std::vector<Magnet> magnets;
  double dialect = 0;                     ///< moment per unit of a field of the dialect [A m^2]
  std::vector<std::string> tag_payloads;  ///< as in World
};

PoseSource pose_source(const Population& population);

/// @param to  is cleared; keeps its memory
void fill(const PoseSource& source, const Moment& from, v1::Poses& to);

}  // namespace ziggurat::channels
