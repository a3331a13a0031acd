// SPDX-License-Identifier: MIT
#pragma once
// Comparison of two protobuf messages of one type.

#include <google/protobuf/message.h>

#include <optional>
#include <string>
#include <string_view>

namespace ziggurat::v1 {
class Commands;
}

namespace ziggurat::replay {

struct FieldDifference {
  std::string field;  ///< as `radios[2].payload`
  std::string a, b;   ///< both values; `nothing` if it is missing
};

/// The first field that differs, in the order of the type. Numbers of worlds (`generation`), which
/// count changes, are no difference.
std::optional<FieldDifference> first_difference(const google::protobuf::Message& a,
                                                const google::protobuf::Message& b);

/// The same for two encoded messages.
/// @param type  its full name; nothing is found in messages of a type that this version lacks
std::optional<FieldDifference> first_difference(const std::string& type, std::string_view a,
                                                std::string_view b);

/// Commands of a recording have what has changed: this makes them all that hold.
/// @param from  of the next inputs
/// @param held  after those before
void take_over(const v1::Commands& from, v1::Commands& held);

}  // namespace ziggurat::replay
