// SPDX-License-Identifier: MIT
#pragma once
// The directors of a world: who may direct it, who does, and what they want done.

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "network/barrier/deadlines.h"
#include "network/barrier/metrics.h"
#include "network/barrier/ownership.h"
#include "network/config.h"
#include "network/report.h"
#include "scene/scene.h"
#include "wire/direction.h"
#include "wire/world_view.h"

namespace ziggurat::network {

/// Checks a Direction against the world in its current state. No fault: it can be applied.
using CheckDirection = std::function<std::optional<wire::Fault>(const wire::Direction&)>;

/// Each director has the same number in all lists. Those of the scene come first, then those from
/// outside in the order in which they came.
struct Directors {
  std::vector<scene::Director> all;
  Ownership ownership;
  Deadlines deadlines;  ///< each director is a controller of its own
  Metrics metrics;
  std::vector<std::optional<wire::Direction>>
      answers;                          ///< to the current tick; none yet, or missed
  std::vector<std::size_t> by_id;       ///< their numbers, in the order of their ids
  bool are_allowed = false;             ///< from outside, that the scene does not name
  Config::Deadline deadline_of_others;  ///< of these
  CheckDirection check;                 ///< may be empty
  std::optional<wire::Truth> truth;     ///< of the current tick; none: there is none to tell
  std::vector<Directed> directed;       ///< what directions() returns

  /// Its number, if there is or was one of that id.
  std::optional<std::size_t> find(const std::string& id) const {
    const auto found = std::ranges::find(all, id, &scene::Director::id);
    if (found == all.end()) return std::nullopt;
    return static_cast<std::size_t>(found - all.begin());
  }
};

}  // namespace ziggurat::network
