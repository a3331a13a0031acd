#pragma once
// The check of `repeated uint32 robots`, which several messages share.

#include <google/protobuf/repeated_field.h>

#include <cstdint>
#include <optional>

#include "wire/messages.h"
#include "wire/roster.h"

namespace ziggurat::wire {

/// Positions name robots of the session that have not left, each at most once.
std::optional<Fault> check_positions(const google::protobuf::RepeatedField<std::uint32_t>& robots,
                                     const Roster& roster, const world::Layout& layout);

}  // namespace ziggurat::wire
