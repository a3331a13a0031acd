#pragma once
// The joint between simulation and network: the loop that every run is.

#include <chrono>
#include <cstdint>
#include <optional>

#include "network/server.h"
#include "reports/summary.h"
#include "run/recorders.h"
#include "run/watch.h"
#include "simulation/simulation.h"
#include "supervision/supervision.h"

namespace ziggurat::run {

/// How long, and how fast.
struct Plan {
  std::optional<std::uint64_t> ticks;  ///< nothing = until stopped
  std::optional<double> real_time;     ///< simulated seconds per second of the wall, if paced
  std::optional<scene::Clock> clock;   ///< overrides the scene's
};

/// What a run consists of.
struct Driven {
  simulation::Simulation& simulation;
  network::Server& server;
  Watch& watch;
  supervision::Supervision& supervision;
};

/// Moves the world from tick 0 to its end, again after each reset, and fills in where the wall time
/// went.
/// @throws recording::WriteError, ConsoleError
reports::Ending drive(const Plan& plan, const Driven& driven, const scene::Scene& scene,
                      Recorders& recorders, reports::Summary& summary);

}  // namespace ziggurat::run
