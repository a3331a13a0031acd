// The end of a run: what controllers are told, what is printed, and in which order.

#include <fmt/format.h>

#include "recording/hash_file.h"
#include "reports/report_card.h"
#include "run/run.h"
#include "run/setup.h"

namespace ziggurat::run {

/// The error is reported by the caller. Before that controllers are told, and the other files are
/// completed; errors on the way are of no interest any more.
void Run::end_in_failure(const std::exception& error) {
  try {
    recorders_.close();
  } catch (const recording::WriteError&) {
  }
  try {
    watch_.end_run({wire::EndReason::failed, error.what(), world_.simulation.state().tick});
  } catch (const reports::ConsoleError&) {
  }
}

void Run::complete_summary() {
  const simulation::Simulation& simulation = world_.simulation;
  summary_.ticks = simulation.state().tick;
  summary_.simulated_s = static_cast<double>(summary_.ticks) * simulation.tick_length();
  summary_.wall_s =
      summary_.physics_s + summary_.exchange_s + summary_.recording_s + summary_.pacing_s;
  summary_.seed = world_.seed;  // a reset may have changed it
  summary_.hash = simulation.hash();
  summary_.solver_name = scene::to_text(world_.scene.physics.solver);
  summary_.solver = supervision::solver_status(simulation);
  summary_.dropped = watch_.dropped();
  summary_.drops_are_failures = !options_.allow_drops;
  summary_.vanished = watch_.vanished();
  const auto performance = server_.performance();
  for (std::size_t c = 0; c < performance.size(); ++c) {
    const std::uint64_t missed = performance[c].missed_ticks;
    if (missed > 0) summary_.missed.push_back({world_.scene.controllers[c].id, missed});
  }
}

/// Prints and writes the report card, if an option asks for it. False if the gate was missed.
bool Run::report_hil() {
  const bool is_wanted = options_.hil || !options_.injections.empty() || !options_.gate.empty() ||
                         !options_.report_card.empty();
  if (!is_wanted) return true;
  reports::ReportCard card{{}, summary_.ticks, summary_.late_ticks, options_.gate};
  const auto performance = server_.performance();
  for (std::size_t c = 0; c < performance.size(); ++c) {
    const auto& [latencies, missed, lost] = performance[c];
    if (latencies.count() == 0 && missed == 0) continue;  // controls no robot
    card.controllers.push_back(
        {world_.scene.controllers[c].id, latencies, missed, config_.injections[c], lost});
  }
  recorders_.write_report_card(card);
  console_.report(to_text(card));
  return passes(card);
}

/// After every process has ended. The hash is the very last line.
void Run::print_summary() {
  if (!summary_.vanished.empty()) console_.fault(summary_.vanished);
  for (const auto& failure : summary_.failures) {
    console_.fault(fmt::format("robot {} (controller '{}') had failed at tick {}: {}",
                               failure.robot, failure.controller, failure.tick,
                               failure.message.substr(0, failure.message.find('\n'))));
  }
  if (const auto deaf = radio_watch_.warning(world_.simulation.layout()); !deaf.empty()) {
    console_.warning(deaf);
  }
  console_.report(options_.json ? to_json(summary_) : to_text(summary_));
  if (options_.hash) console_.result(recording::hash_line(summary_.ticks, summary_.hash));
  console_.flush();
}

}  // namespace ziggurat::run
