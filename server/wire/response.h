// SPDX-License-Identifier: MIT
#pragma once
// Requests and responses between plain data and protobuf.

#include <span>

#include "wire/request.h"
#include "world/state.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {

Request read(const v1::Request& request);
Request read(const v1::MoveRequest& request);
Request read(const v1::SetJointRequest& request);

void fill(const Status& status, v1::Status& to);

/// @param entities  into Layout::entities, ascending
void fill(const world::Layout& layout, const world::State& state,
          std::span<const std::size_t> entities, v1::States& to);

}  // namespace ziggurat::wire
