// SPDX-License-Identifier: MIT
// Notices of a run: what its author should know before it begins, and what goes wrong while it
// runs.

#include <fmt/format.h>

#include "run/options/option_checks.h"
#include "run/run.h"
#include "simulation/scene_warnings.h"

namespace ziggurat::run {

void Run::print_notices() {
  for (const auto& doubt : simulation::scene_warnings(world_.scene, world_.simulation))
    console_.problem(doubt);
  for (const auto& notice : world_.simulation.notices())
    console_.notice(start_.scene_path() + ": " + notice);
  if (config_.curve) {
    for (const auto& doubt :
         doubts_of(config_.curve->clients, world_.scene, world_.simulation.layout()))
      console_.notice(doubt);
  }
  if (options_.seed.value_or(start_.usual_seed(world_.scene)) == 0) {
    console_.notice(fmt::format("seed {0} drawn; --seed {0} repeats this run", world_.seed));
  }
  if (options_.paused) {
    return console_.notice("paused, as --paused asks; 'ziggurat ctl URL resume' begins");
  }
  const bool has_controllers =
      robots_without_controller().size() < world_.simulation.layout().robots.size();
  if (service_ == Service::run || plan_.real_time || has_controllers) return;
  server_.set_paused(true);  // otherwise the run would be over before a supervisor can connect
  console_.notice(
      "paused: the scene has no controllers; start the server with --real-time, or write "
      "'ziggurat ctl URL resume'");
}

/// A notice when the physics' solver has not converged for the first time, and one when something
/// makes it slow.
void Run::print_troubles() {
  if (const auto notice =
          printed_.slow ? std::nullopt : simulation::slow_notice(world_.simulation)) {
    printed_.slow = true;
    console_.notice(fmt::format("tick {}: {}", world_.simulation.state().tick, *notice));
  }
  const wire::SolverStatus solver = supervision::solver_status(world_.simulation);
  if (printed_.not_converged || solver.not_converged == 0) return;
  printed_.not_converged = true;
  console_.notice(fmt::format(
      "tick {}: the solver did not converge: bodies that touch miss the laws of contact by up to "
      "{:.2g} m/s or rad/s, or light links carry more than a substep can follow; more iterations "
      "in "
      "<dynamics3d> make substeps shorter; the summary counts such cases",
      world_.simulation.state().tick, solver.worst_residual));
}

}  // namespace ziggurat::run
