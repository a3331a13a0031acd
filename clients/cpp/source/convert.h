// SPDX-License-Identifier: MIT
#pragma once
// Values of messages as values of handles.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "ziggurat/actuators.h"
#include "ziggurat/radio.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat {

inline std::size_t size(int count) { return static_cast<std::size_t>(count); }

/// Numbers that are missing in the list leave those of the array as they are.
template <std::size_t n>
void copy(const google::protobuf::RepeatedField<double>& from, std::array<double, n>& to) {
  std::copy_n(from.begin(), std::min(n, size(from.size())), to.begin());
}

/// @param value  0xRRGGBB
inline Color color_of(std::uint32_t value) {
  return {static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 8),
          static_cast<std::uint8_t>(value)};
}

/// 0xRRGGBB
inline std::uint32_t packed(Color color) {
  return std::uint32_t{color.red} << 16 | std::uint32_t{color.green} << 8 | color.blue;
}

inline Bytes bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// @throws std::invalid_argument that says what is allowed
void check_metric(std::string_view name, double value);

}  // namespace ziggurat
