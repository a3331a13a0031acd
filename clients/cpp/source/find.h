// SPDX-License-Identifier: MIT
#pragma once
// Devices by id.

#include <stdexcept>
#include <string>
#include <string_view>

#include "text/printable.h"

namespace ziggurat {

/// The device of that id among those of a robot.
/// @param robot, kind  for the message: "robot 'a'", "joint"
/// @throws std::out_of_range, naming those there are
template <typename Devices>
auto& find(Devices& devices, std::string_view id, const std::string& robot,
           const std::string& kind) {
  for (auto& device : devices) {
    if (device.id() == id) return device;
  }
  std::string message = robot + " has no " + kind + " '" + std::string(id) +
                        "' that its controller senses or sets; it has ";
  if (devices.empty()) message += "none";
  for (const auto& device : devices) {
    message += (&device == devices.data() ? "'" : ", '") + device.id() + "'";
  }
  throw std::out_of_range(text::printable_part(message));
}

}  // namespace ziggurat
