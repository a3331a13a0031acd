// SPDX-License-Identifier: MIT
#pragma once
// Wall time of recent ticks by phase.

#include <array>
#include <cstddef>
#include <cstdint>

#include "timing/phases.h"
#include "wire/request.h"

namespace ziggurat::supervision {

class TickBudget {
 public:
  static constexpr std::size_t remembered = 1000;  ///< ticks

  /// Adds a tick.
  void add(const timing::PhaseTimes& tick);

  /// Appends each phase of the remembered ticks that has any time to the status.
  void fill(wire::Status& status) const;

 private:
  std::array<std::array<float, timing::phase_count>, remembered> ticks_{};  // oldest overwritten
  std::uint64_t count_ = 0;
};

}  // namespace ziggurat::supervision
