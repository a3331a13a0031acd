// SPDX-License-Identifier: MIT
#pragma once
// Comparison of two recordings: their first difference, and the distance of their poses over time.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "recording/replay/difference.h"
#include "recording/replay/recording_file.h"

namespace ziggurat::rerun {

struct Divergence {
  struct State {
    std::uint64_t epoch = 0, tick = 0;
    double time_s = 0;  ///< simulated, since the start of the first epoch
    replay::Distance apart;
  };
  std::string path_a, path_b;
  std::uint64_t compared = 0;            ///< states with the same epoch and tick
  std::uint64_t only_a = 0, only_b = 0;  ///< states that the other one lacks
  /// Sentences on the first state that differs, and on the first inputs that do.
  std::optional<std::string> first_state, first_inputs;
  std::vector<State>
      states;  ///< that were compared, if their exact poses are recorded; a million at most
  std::vector<std::string> names;  ///< of links

  bool is_same() const { return !first_state && only_a == 0 && only_b == 0; }
};

/// Links are compared by their names, if both recordings have them.
/// @throws replay::RecordingError
Divergence compare(const replay::RecordingFile& a, const replay::RecordingFile& b);

/// First difference, then a table of about 20 rows.
std::string to_text(const Divergence& divergence);
/// One object.
std::string to_json(const Divergence& divergence);
/// Distances over time, both logarithmic.
std::string to_svg(const Divergence& divergence);

}  // namespace ziggurat::rerun
