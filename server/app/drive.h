#pragma once
// The joint between simulation and network: the loop that every run is.

#include <chrono>
#include <cstdint>
#include <optional>

#include "app/recorders.h"
#include "app/summary.h"
#include "app/watch.h"
#include "network/server.h"
#include "simulation/simulation.h"

namespace ziggurat::app {

/// How long, and how fast.
struct Plan {
  std::optional<std::uint64_t> ticks;  ///< nothing = until stopped
  std::optional<double> real_time;     ///< simulated seconds per second of the wall, if paced
};

/// Moves the world from tick 0 to its end, and fills in where the wall time went.
/// @throws recording::WriteError, ConsoleError
Ending drive(const Plan& plan, simulation::Simulation& simulation, network::Server& server,
             Watch& watch, Recorders& recorders, Summary& summary);

}  // namespace ziggurat::app
