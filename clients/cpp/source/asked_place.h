// SPDX-License-Identifier: MIT
#pragma once
// The question whether a place is free.

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "ziggurat/v1/envelope.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat {

/// @param what  an id, or an element, which begins with '<'
inline void ask_for_place(std::string_view what, const std::array<double, 3>& position,
                          const std::optional<std::array<double, 4>>& orientation,
                          v1::IsFreeRequest& request) {
  const std::size_t first = what.find_first_not_of(" \t\r\n");
  const bool is_element = first != what.npos && what[first] == '<';
  (is_element ? *request.mutable_xml() : *request.mutable_entity()) =
      v1::valid_utf8(std::string(what));
  for (const double value : position) request.add_position(value);
  if (!orientation) return;
  for (const double value : *orientation) request.add_orientation(value);
}

/// The id of what is there; nothing if the place is free.
inline std::optional<std::string> overlapped_in(const v1::Response& response) {
  const std::string& id = response.place().overlapped();
  return id.empty() ? std::nullopt : std::optional(id);
}

}  // namespace ziggurat
