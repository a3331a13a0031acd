#include "app/drive.h"

namespace ziggurat::app {
namespace {

using clock = std::chrono::steady_clock;

// Charges the time since the last call to one account.
class Laps {
 public:
  void charge(double& account_s) {
    const auto now = clock::now();
    account_s += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  clock::time_point last_ = clock::now();
};

// The absolute schedule of a paced run: being late once doesn't move what comes after.
std::optional<Ending> pace(double factor, const simulation::Simulation& simulation,
                           clock::time_point start, Watch& watch, Summary& summary) {
  const double due_s = static_cast<double>(simulation.state().tick + 1) * simulation.tick_length();
  const auto due = start + std::chrono::duration_cast<clock::duration>(
                               std::chrono::duration<double>(due_s / factor));
  if (clock::now() > due) ++summary.late_ticks;
  return watch.sleep_until(due);
}

}  // namespace

Ending drive(const Plan& plan, simulation::Simulation& simulation, network::Server& server,
             Watch& watch, Recorders& recorders, Summary& summary) {
  Laps laps;
  const auto& now = simulation.state();
  const auto stopped_early = watch.gather();
  laps.charge(summary.startup_s);
  if (stopped_early) return *stopped_early;
  const auto start = clock::now();
  for (;;) {
    // Controllers compute while we write.
    server.publish(simulation.observations(), now.tag_payloads);
    laps.charge(summary.exchange_s);
    recorders.tick(simulation);
    laps.charge(summary.recording_s);

    const auto stopped = watch.collect(simulation.commands(), now.tick);
    laps.charge(summary.exchange_s);
    if (stopped) return *stopped;
    recorders.exchange(simulation.state(), simulation.observations(), simulation.commands());
    laps.charge(summary.recording_s);
    if (now.tick == plan.ticks) return Ending::finished;

    if (plan.real_time) {
      const auto stopped_asleep = pace(*plan.real_time, simulation, start, watch, summary);
      laps.charge(summary.pacing_s);
      if (stopped_asleep) return *stopped_asleep;
    }
    simulation.step();
    laps.charge(summary.physics_s);
  }
}

}  // namespace ziggurat::app
