// SPDX-License-Identifier: MIT
#pragma once
// Deadline policies: the consequence when a controller does not answer in time.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace ziggurat::scene {

/// Numbers as in the protocol.
enum class DeadlineAction {
  wait = 1,  ///< the world waits without end
  hold,      ///< what was commanded before stays
  zero,      ///< commands become zero
  drop,      ///< the robots leave the barrier for good
  stop,      ///< the run ends
};

struct DeadlinePolicy {
  DeadlineAction action = DeadlineAction::wait;
  std::uint32_t wall_deadline_ms = 0;  ///< > 0 unless the action is wait
  std::uint32_t miss_budget = 0;       ///< misses in a row that are held (drop, stop), or after
                                       ///< which robots leave (hold, zero; 0 is never)
  bool operator==(const DeadlinePolicy&) const = default;
};

/// The action of that name; nothing if there is none.
std::optional<DeadlineAction> deadline_action(std::string_view name);

/// As on the command line: "hold:50:10".
std::string to_text(const DeadlinePolicy& policy);

}  // namespace ziggurat::scene
