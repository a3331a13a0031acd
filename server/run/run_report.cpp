// SPDX-License-Identifier: MIT
// The end of a run: what controllers are told, what is printed, and in which order.

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "outputs/hash_file.h"
#include "reports/report_card.h"
#include "run/run.h"
#include "run/setup.h"

namespace ziggurat::run {

/// The error is reported by the caller. Before that controllers are told, and the other files are
/// completed; errors on the way are of no interest any more.
void Run::end_in_failure(const std::exception& error) {
  try {
    recorders_.close();
  } catch (const std::runtime_error&) {
  }
  try {
    watch_.end_run({wire::EndReason::failed, error.what(), world_.simulation.state().tick});
  } catch (const reports::ConsoleError&) {
  }
  try {
    if (recorded_) recorded_->close();
  } catch (const outputs::WriteError&) {
  }
}

void Run::complete_summary() {
  const simulation::Simulation& simulation = world_.simulation;
  statistics_.summary.ticks = simulation.state().tick;
  statistics_.summary.simulated_s =
      static_cast<double>(statistics_.summary.ticks) * simulation.tick_length();
  statistics_.summary.seed = world_.seed;  // a reset may have changed it
  statistics_.summary.hash = simulation.hash();
  statistics_.summary.solver = supervision::solver_status(simulation);
  statistics_.summary.dropped = watch_.dropped();
  statistics_.summary.drops_are_failures = !options_.allow_drops;
  statistics_.summary.vanished = watch_.vanished();
  statistics_.summary.shutdown_reason = supervision_.requested_shutdown().value_or("");
  const auto controllers = server_.performance().controllers;
  for (std::size_t c = 0; c < controllers.size(); ++c) {
    const std::uint64_t missed = controllers[c].missed_ticks;
    if (missed > 0) statistics_.summary.missed.push_back({world_.scene.controllers[c].id, missed});
  }
}

reports::ReportCard Run::report_card() const {
  const world::Layout& layout = world_.simulation.layout();
  reports::ReportCard card;
  card.scene = start_.scene_path();
  card.seed = world_.seed;
  card.date = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}",
                          fmt::gmtime(std::chrono::system_clock::to_time_t(statistics_.date)));
  if (plan_.real_time) card.period_s = world_.simulation.tick_length() / *plan_.real_time;
  card.ticks = statistics_.summary.ticks;
  card.warm_up = options_.warm_up;
  card.gate = options_.gate;
  card.starts = statistics_.tick_starts;
  for (const auto& robot : layout.robots) card.robots.push_back(robot.id);
  const network::Performance performance = server_.performance();
  for (std::size_t c = 0; c < performance.controllers.size(); ++c) {
    card.controllers.push_back({world_.scene.controllers[c].id, {}});
    card.controllers[c].injected = config_.injections[c];
    card.controllers[c].lost = performance.controllers[c].lost;
  }
  for (const network::Reaction& one : performance.reactions.all) {
    card.controllers[one.controller].reactions.push_back(one);
  }
  const auto status = server_.status();
  for (std::size_t r = 0; r < status.size(); ++r) {
    auto& deadlines = card.controllers[layout.robots[r].controller].deadlines;
    const bool is_new = std::ranges::find(deadlines, status[r].deadline) == deadlines.end();
    if (is_new) deadlines.push_back(status[r].deadline);
  }
  // Controllers without robots have no card.
  std::erase_if(card.controllers, [](const auto& each) { return each.reactions.empty(); });
  complete(card);
  return card;
}

/// Prints and writes the report card, if an option asks for it. False if the gate was missed.
bool Run::report_hil() {
  if (!config_.keeps_reactions) return true;
  const reports::ReportCard card = report_card();
  recorders_.write_report_card(card);
  console_.report(to_text(card));
  return passes(card);
}

/// After every process has ended. The hash is the very last line.
void Run::print_summary() {
  if (!statistics_.summary.vanished.empty()) console_.fault(statistics_.summary.vanished);
  if (const auto deaf = radio_watch_.warning(world_.simulation.layout()); !deaf.empty()) {
    console_.warning(deaf);
  }
  console_.report(options_.json ? to_json(statistics_.summary) : to_text(statistics_.summary));
  if (options_.hash)
    console_.result(outputs::hash_line(statistics_.summary.ticks, statistics_.summary.hash));
  console_.flush();
}

}  // namespace ziggurat::run
