// SPDX-License-Identifier: MIT
#pragma once
// Changes of the world by supervisors and viewers, as a recording needs them to repeat them.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "math/pose.h"

namespace ziggurat::supervision {

struct Moved {
  std::string entity;
  math::Pose pose;  ///< X_WE, as it was applied
};
struct JointSet {
  std::string entity, joint;
  double position = 0, velocity = 0;  ///< [m] or [rad], [m/s] or [rad/s]
};
struct Spawned {
  std::string xml;
  /// Path, as it was asked for, and text of each file that was read for it.
  std::vector<std::pair<std::string, std::string>> files;
  std::string script;  ///< path of its Lua controller's script; empty if it has none
};
struct Removed {
  std::string entity;
};
/// The world was built again.
struct WasReset {
  std::uint64_t seed = 1;
};
/// The world went back to what was kept under a name.
struct Restored {
  std::string snapshot;
  std::vector<std::byte> bytes;  ///< of its file; empty: it was kept in this run
};
/// The world was kept under a name.
struct SnapshotTaken {
  std::string snapshot;
};
struct Paused {};
struct Resumed {};

using WorldChange = std::variant<Moved, JointSet, Spawned, Removed, WasReset, Restored,
                                 SnapshotTaken, Paused, Resumed>;
using TellWorldChange = std::function<void(const WorldChange&)>;

}  // namespace ziggurat::supervision
