#pragma once
// --gate: conditions that a run can miss.

#include <span>
#include <vector>

#include "network/config.h"
#include "reports/gate.h"

namespace ziggurat::run {

/// Properties of the run that its gate depends on.
struct GateContext {
  std::span<const network::Config::Deadline> deadlines;  ///< of the controllers
  bool may_be_asked = false;  ///< clients of their own may ask for deadlines when they connect
  bool is_paced = false;
};

/// @throws text::UsageError if a condition is always met in this run
void check_gate(const std::vector<reports::Condition>& gate, const GateContext& context);

}  // namespace ziggurat::run
