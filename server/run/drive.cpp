#include "run/drive.h"

#include <array>

namespace ziggurat::run {
namespace {

using clock = std::chrono::steady_clock;

// Charges the time since the last call to one account, and at the end of a tick to its phases.
class Laps {
 public:
  void charge(double& account_s, supervision::Phase phase) {
    const double taken = lap();
    account_s += taken;
    tick_[static_cast<std::size_t>(phase)] += taken;
  }
  void charge(double& account_s) { account_s += lap(); }

  void end_tick(supervision::Supervision& supervision, bool is_paced) {
    for (const supervision::Phase phase :
         {supervision::Phase::exchange, supervision::Phase::physics, supervision::Phase::recording,
          supervision::Phase::pacing}) {
      double& taken = tick_[static_cast<std::size_t>(phase)];
      if (phase != supervision::Phase::pacing || is_paced) supervision.charge(phase, taken);
      taken = 0;
    }
  }

 private:
  double lap() {
    const auto now = clock::now();
    const double taken = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return taken;
  }

  clock::time_point last_ = clock::now();
  std::array<double, 4> tick_{};  // [s], by supervision::Phase
};

// The absolute schedule of a paced run: being late once doesn't move what comes after, a pause
// does.
std::optional<reports::Ending> pace(double factor, const Driven& driven, clock::time_point start,
                                    reports::Summary& summary) {
  simulation::Simulation& simulation = driven.simulation;
  const double due_s = static_cast<double>(simulation.state().tick + 1) * simulation.tick_length();
  const auto due =
      start + driven.supervision.paused_for() +
      std::chrono::duration_cast<clock::duration>(std::chrono::duration<double>(due_s / factor));
  if (clock::now() > due) ++summary.late_ticks;
  return driven.watch.sleep_until(due, simulation.commands());
}

// Until the tick is complete. Somebody may come when it was already, and is waited for, too; or
// pause the world: then it stays where it is.
std::optional<reports::Ending> collect(const Driven& driven) {
  const auto& [simulation, server, watch, supervision] = driven;
  do {
    if (auto stopped = watch.collect(simulation.commands(), simulation.state().tick))
      return stopped;
  } while (server.paused());
  return std::nullopt;
}

/// One world, from tick 0 on.
reports::Ending drive_once(const Plan& plan, const Driven& driven, Recorders& recorders,
                           reports::Summary& summary, Laps& laps) {
  const auto& [simulation, server, watch, supervision] = driven;
  const world::State& now = simulation.state();
  const auto start = clock::now() - supervision.paused_for();
  for (;;) {
    // Controllers compute while we write.
    server.publish(simulation.observations(), now.tag_payloads);
    supervision.published();
    laps.charge(summary.exchange_s, supervision::Phase::exchange);
    recorders.tick(simulation);
    laps.charge(summary.recording_s, supervision::Phase::recording);

    auto stopped = collect(driven);
    laps.charge(summary.exchange_s, supervision::Phase::exchange);
    const bool is_last = now.tick == plan.ticks;
    if (plan.real_time && !stopped && !is_last) {
      stopped = pace(*plan.real_time, driven, start, summary);
      if (!stopped) stopped = collect(driven);
      laps.charge(summary.pacing_s, supervision::Phase::pacing);
    }
    if (stopped) return *stopped;
    recorders.exchange(simulation.state(), simulation.observations(), simulation.commands());
    laps.charge(summary.recording_s, supervision::Phase::recording);
    if (is_last) return reports::Ending::finished;
    simulation.step();
    laps.charge(summary.physics_s, supervision::Phase::physics);
    laps.end_tick(supervision, plan.real_time.has_value());
  }
}

}  // namespace

reports::Ending drive(const Plan& plan, const Driven& driven, const scene::Scene& scene,
                      Recorders& recorders, reports::Summary& summary) {
  Laps laps;
  for (;;) {
    std::optional<reports::Ending> ending = driven.watch.gather();
    laps.charge(summary.startup_s);
    if (!ending) {
      driven.supervision.gathered();
      ending = drive_once(plan, driven, recorders, summary, laps);
    }
    if (ending != reports::Ending::reset) return *ending;
    const std::uint64_t seed = *driven.supervision.reset_wanted();
    driven.simulation.reset(scene, {seed, plan.clock});
    driven.server.reset(seed);
    driven.supervision.reset_done();
    laps.charge(summary.startup_s);
  }
}

}  // namespace ziggurat::run
