// SPDX-License-Identifier: MIT
#pragma once
// A step of a system whose contacts the test finds, and finds again after each impact.

#include <algorithm>
#include <cmath>
#include <vector>

#include "physics/stepping/system.h"

namespace ziggurat::dynamics::testing {

/// @param find  (time) finds the contacts of the coming time [s]
template <class Find>
Report step_with_impacts(System& system, double time_step, std::vector<ContactPoint>& contacts,
                         std::vector<Servo>& servos, std::vector<Limit>& limits, Find find) {
  std::vector<int> chosen;
  Report report;
  const auto find_chosen = [&](double time) {
    find(time);
    const auto is_other = [&](int tree) {
      return !chosen.empty() && tree >= 0 && system.trees[tree].dofs > 0 &&
             !std::ranges::binary_search(chosen, tree);
    };
    std::erase_if(contacts, [&](const ContactPoint& contact) {
      return is_other(contact.a.tree) || is_other(contact.b.tree);
    });
  };
  const auto advance = [&](double time, double, ImpactMode mode) {
    system.options.impact_mode = mode;
    find_chosen(time);
    report = system.step(time, contacts, servos, limits, chosen);
    double next = HUGE_VAL;
    for (const auto& island : system.islands_to_subdivide.islands)
      next = std::min(next, island.impact_time);
    if (next == HUGE_VAL) return next;
    chosen = system.islands_to_subdivide.trees;
    std::ranges::sort(chosen);
    return next;
  };
  const auto strike = [&] {
    find_chosen(1e-3 * time_step);
    system.apply_impacts(contacts, servos, limits, chosen);
  };
  const double first = advance(time_step, time_step, ImpactMode::end_step);
  if (first != HUGE_VAL) step_through_impacts(time_step, first, advance, strike);
  return report;
}

}  // namespace ziggurat::dynamics::testing
