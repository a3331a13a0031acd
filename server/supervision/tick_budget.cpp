#include "supervision/tick_budget.h"

namespace ziggurat::supervision {
namespace {

constexpr std::array<const char*, phase_count> names{"exchange", "physics", "recording", "pacing"};

}  // namespace

void TickBudget::add(Phase phase, double seconds) {
  times_[static_cast<std::size_t>(phase)].add(seconds);
}

void TickBudget::fill(wire::Status& status) const {
  for (std::size_t i = 0; i < times_.size(); ++i) {
    if (times_[i].count() > 0) status.budget.push_back({names[i], times_[i].recent()});
  }
}

}  // namespace ziggurat::supervision
