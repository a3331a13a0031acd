// SPDX-License-Identifier: MIT
#pragma once
// Vectors and rotations as packed numbers of messages, and names of frames.

#include <google/protobuf/repeated_field.h>

#include <string>

#include "math/pose.h"
#include "world/layout.h"
#include "world/state.h"
#include "ziggurat/v1/envelope.h"

namespace ziggurat::channels {

template <class Number>
void add(const math::Vector3& from, google::protobuf::RepeatedField<Number>& to) {
  for (const double value : from) to.Add(static_cast<Number>(value));
}
template <class Number>
void add(const math::Quaternion& from, google::protobuf::RepeatedField<Number>& to) {
  for (const double value : {from.w(), from.x(), from.y(), from.z()}) {
    to.Add(static_cast<Number>(value));
  }
}

inline std::uint32_t index(std::size_t place) { return static_cast<std::uint32_t>(place); }

/// The frame of a link in Foxglove's messages: `ENTITY`, or `ENTITY/LINK`.
inline std::string frame_of(const world::Layout& layout, std::size_t link) {
  const world::LinkLayout& own = layout.links[link];
  const std::string& entity = layout.entities[own.entity].id;
  return v1::valid_utf8(own.id.empty() ? entity : entity + "/" + own.id);
}

/// A place on a link.
struct Mounted {
  std::size_t link = 0;  ///< into State::links
  math::Pose pose;       ///< X_LD
};

}  // namespace ziggurat::channels
