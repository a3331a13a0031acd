// SPDX-License-Identifier: MIT
#pragma once
// Exact inputs and result of a step: the messages `Commands` and `ExactState` of run.proto. Writers
// and readers of recordings share it.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "world/commands.h"
#include "world/layout.h"
#include "world/state.h"

namespace ziggurat::v1 {
class Commands;
class ExactState;
}  // namespace ziggurat::v1

namespace ziggurat::recording {

/// Packs the commands of one step after the other, all arrays at the first call. A new epoch takes
/// a new one.
class CommandPacker {
 public:
  /// Later, arrays that are as in the call before are left out; radio messages never are.
  /// @param to  is empty before
  void pack(const world::Commands& commands, v1::Commands& to);

 private:
  world::Commands last_;  ///< without radio messages
  bool is_first_ = true;
};

/// The inverse: takes over what a message has; arrays that it leaves out stay as they are.
/// @param layout  of the world that is to be stepped, in which `state` has the absent entities
/// @param like    commands of this world: how many values each array must have
/// @param to      of the message before; none has been read: empty
/// @returns what is wrong with the message, if anything; then `to` has no meaning
std::optional<std::string> unpack(const v1::Commands& from, const world::Layout& layout,
                                  const world::State& state, const world::Commands& like,
                                  world::Commands& to);

/// Packs the links of one tick after the other.
class StatePacker {
 public:
  /// Links with other bits than in the call before; all if their number has changed.
  /// @param to  is empty before
  void pack(std::uint64_t epoch, const world::State& state, v1::ExactState& to);

 private:
  std::vector<world::LinkState> last_;
};

/// The inverse: `to` are the links of the message before.
/// @returns what is wrong with the message, if anything; then `to` is as before
std::optional<std::string> unpack(const v1::ExactState& from, std::vector<world::LinkState>& to);

}  // namespace ziggurat::recording
