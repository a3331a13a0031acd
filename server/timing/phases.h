// SPDX-License-Identifier: MIT
#pragma once
// Phases of a tick, and the wall time of each.

#include <array>
#include <cstddef>
#include <cstdint>

namespace ziggurat::timing {

/// Parts of a run's wall time. All but the first are parts of a tick, in the order of a tick.
enum class Phase : std::uint8_t {
  startup,    ///< until every robot has its controller; the wait for a first viewer
  encode,     ///< observations written as messages and sent
  wait,       ///< for controllers; their commands are read meanwhile
  forces,     ///< what directors and commands do; forces other than magnetic ones
  magnetism,  ///< fields, magnetic forces and torques
  contacts,   ///< contact points, and the constraints of a substep
  solve,      ///< islands, and their velocity problems
  integrate,  ///< motion, corrections of positions, sleep
  sensing,    ///< states and readings
  recording,  ///< files, recordings, what viewers see
  pacing,     ///< for the wall clock
};
constexpr std::size_t phase_count = 11;
constexpr std::array<const char*, phase_count> phase_names{
    "startup", "encode",    "wait",    "forces",    "magnetism", "contacts",
    "solve",   "integrate", "sensing", "recording", "pacing"};

/// Wall time of each phase [s].
struct PhaseTimes {
  std::array<double, phase_count> seconds{};  ///< by Phase

  double& operator[](Phase phase) { return seconds[static_cast<std::size_t>(phase)]; }
  double operator[](Phase phase) const { return seconds[static_cast<std::size_t>(phase)]; }
  PhaseTimes& operator+=(const PhaseTimes& other);

  double exchange() const { return sum(Phase::encode, Phase::wait); }
  double physics() const { return sum(Phase::forces, Phase::sensing); }
  double ticks() const { return sum(Phase::encode, Phase::pacing); }  ///< all but the start-up

 private:
  double sum(Phase first, Phase last) const;
};

}  // namespace ziggurat::timing
