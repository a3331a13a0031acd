// SPDX-License-Identifier: MIT
#pragma once
// Impacts. A contact with restitution that closes within a step ends the step of its island: the
// island advances to the impact without it, the impact law acts at the configuration of the impact,
// and the rest of the step follows.

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "physics/solver/newton.h"

namespace ziggurat::dynamics {

/// Treatment of contacts with restitution in a step.
enum class ImpactMode {
  end_step,  ///< an island with an impact is left unchanged, to be advanced to it
  between,   ///< no impact takes place in the step: contacts that close fast do not act
  inelastic  ///< all act, without restitution
};

/// Memory of an impact search or an impact law.
struct ImpactMemory {
  struct Closing {
    int constraint = 0;   ///< index of a contact in the problem
    double velocity = 0;  ///< separation velocity at the step's beginning [m/s]
  };
  std::vector<Closing> closing;
  std::vector<std::array<double, Constraint::most_rows>> impulses, sum;
  std::vector<double> velocity, inelastic, elastic;
  std::vector<unsigned char> carries;
};

/// Finds the first impact of an island: the earliest time at which a contact with restitution
/// closes with more than the restitution threshold, while no such contact acts. Contacts that close
/// so fast, within the step or later, become Law::off; all others keep their law. The gap is a
/// parabola: of the velocity at the step's beginning, and the mean acceleration of the step without
/// these contacts. Wrenches act as an impulse at the beginning; with them, or with servos, the gap
/// may also be a line of the velocity at the end.
/// @param problem  assembled, with the velocities of the beginning; keeps them
/// @return         from the step's beginning [s]; HUGE_VAL: none
double find_first_impact(Problem& problem, VelocitySolver& solver, ImpactMemory& memory);

/// Applies Newton's impact law with friction to the touching contacts of an island, one after
/// another as long as one approaches: separation velocity after = -restitution * before. Contacts
/// that carried a load, or have no restitution, hold meanwhile. The work of the contact impulses is
/// not positive: else a part of the rebound is left out.
/// @param problem  assembled for an instant; out: velocities after the impact, and the sum of the
/// impulses
/// @return         whether there was an impact
bool apply_impact_law(Problem& problem, VelocitySolver& solver, ImpactMemory& memory);

/// Advances an island through the impacts of a step, one after another.
/// @param time_step     of the step [s]
/// @param first_impact  from its beginning [s]
/// @param advance       (time step, time left with it, ImpactMode) → time of the next impact in it,
/// with which it has left
///                      the island unchanged, or HUGE_VAL
/// @param strike        applies the impact law at the present configuration
template <class Advance, class Strike>
void step_through_impacts(double time_step, double first_impact, Advance advance, Strike strike) {
  constexpr int most_rounds = 200;    // then the rest of the step is inelastic
  constexpr double shortest = 1e-12;  // step [s]
  double left = time_step, next = first_impact;
  for (int round = 1; left > shortest; ++round) {
    next = std::min(next, left);
    if (next > shortest) {
      advance(next, left, ImpactMode::between);
      left -= next;
    }
    strike();
    if (left <= shortest) return;
    next = advance(left, left, round < most_rounds ? ImpactMode::end_step : ImpactMode::inelastic);
    if (next == HUGE_VAL) return;
  }
}

}  // namespace ziggurat::dynamics
