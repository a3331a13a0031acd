#include "run/phase_timer.h"

namespace ziggurat::run {

using supervision::Phase;

namespace {

double& total_of(Phase phase, reports::Summary& summary) {
  switch (phase) {
    case Phase::exchange:
      return summary.exchange_s;
    case Phase::physics:
      return summary.physics_s;
    case Phase::recording:
      return summary.recording_s;
    case Phase::pacing:
      break;
  }
  return summary.pacing_s;
}

}  // namespace

void PhaseTimer::end_phase(Phase phase, reports::Summary& summary) {
  const double taken = restart();
  total_of(phase, summary) += taken;
  tick_[static_cast<std::size_t>(phase)] += taken;
}

void PhaseTimer::end_tick(supervision::Supervision& supervision, bool is_paced) {
  last_tick_ = tick_;
  for (const Phase phase : {Phase::exchange, Phase::physics, Phase::recording, Phase::pacing}) {
    double& taken = tick_[static_cast<std::size_t>(phase)];
    if (phase != Phase::pacing || is_paced) supervision.charge(phase, taken);
    taken = 0;
  }
}

double PhaseTimer::restart() {
  const auto now = clock::now();
  const double taken = std::chrono::duration<double>(now - last_).count();
  last_ = now;
  return taken;
}

}  // namespace ziggurat::run
