// SPDX-License-Identifier: MIT
#pragma once
// Acts of directors on the world, as plain data.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "wire/messages.h"
#include "wire/request.h"
#include "world/state.h"

namespace ziggurat::v1 {
class Direction;
}

namespace ziggurat::wire {

inline constexpr std::size_t most_acts = 10'000;  // of a Direction
inline constexpr std::size_t most_spawns = 1000;  // among them: each takes longer than another act
inline constexpr std::size_t most_direction_logs = 1000;                // lines of a Direction
inline constexpr std::size_t longest_direction = std::size_t{4} << 20;  // [bytes]
inline constexpr std::size_t longest_result = 1024;                     // of a run [bytes]

/// LEDs and tags of an entity. Each list is empty or has a value for each of its devices.
struct Show {
  std::string entity;
  std::vector<world::Color> led_colors, directional_led_colors;  ///< at most 0xFFFFFF
  std::vector<std::string> tag_payloads;
};

/// A force and a torque on a link during the next tick.
struct Push {
  std::string entity;
  std::string link;                ///< id; empty: the entity's first one
  std::array<double, 3> force{};   ///< at its centre of mass, in W [N]
  std::array<double, 3> torque{};  ///< in W [N m]
};

/// An image that shall cover the arena's floor.
struct LayImage {
  std::string file;  ///< its bytes
};

/// A Request is one to move, spawn or remove.
using DirectorAct = std::variant<Request, Show, Push, world::FloorPaint, LayImage>;

/// Checked, but for what only the world can tell.
struct Direction {
  std::vector<DirectorAct> acts;
  std::vector<Metric> metrics;        ///< `robot` has no meaning
  std::vector<LogLine> log;           ///< likewise
  std::optional<std::string> finish;  ///< the run ends with this result
};

/// Checks a Direction without regard to the world or its tick.
std::optional<Fault> check(const v1::Direction& direction);
/// @param direction  checked
Direction read(const v1::Direction& direction);

}  // namespace ziggurat::wire
