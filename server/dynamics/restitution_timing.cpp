#include "dynamics/restitution_timing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "dynamics/constraint.h"
#include "dynamics/sequential_impacts.h"

namespace ziggurat::dynamics {
namespace {

/// Larger islands are not looked at for what they do not come to meet.
constexpr std::size_t most_blocks = 300;

/// Whether a side of a contact is a larger tree than responses are worked out for.
bool is_large(const Problem& problem, const Constraint& constraint) {
  return std::ranges::any_of(std::array{constraint.a, constraint.b}, [&](int index) { return index >= 0 && problem.trees[index]->dofs > most_dofs_struck; });
}

/// Whether a contact held what is on it in the last substep, and does not part.
bool may_carry(const Problem& problem, const Constraint& constraint) {
  constexpr double resting = 1e-3;  // what parts faster does not carry any more [m/s]
  if (constraint.kind != Constraint::Kind::contact || constraint.impulse[0] == 0 || constraint.gap > problem.allowed_overlap) return false;
  double u[Constraint::most_rows];
  problem.constraint_velocity(constraint, u);
  return u[0] <= resting;
}

/// Notes which trees what touches them from below carries, and what contacts gave them in the last substep.
void find_carried(Problem& problem) {
  problem.carried.assign(problem.trees.size(), 0.0);
  problem.pressed.assign(problem.trees.size(), Vector3::Zero());
  for (const Constraint& constraint : problem.constraints) {
    if (constraint.kind != Constraint::Kind::contact) continue;
    Vector3 push = Vector3::Zero();
    for (int r = 0; r < std::min(constraint.rows, 3); ++r) push += constraint.impulse[r] * constraint.frame.col(r);
    if (constraint.a >= 0) problem.pressed[constraint.a] += push;
    if (constraint.b >= 0) problem.pressed[constraint.b] -= push;
    if (!may_carry(problem, constraint)) continue;
    if (constraint.a >= 0) problem.carried[constraint.a] -= push.dot(problem.trees[constraint.a]->gravity);
    if (constraint.b >= 0) problem.carried[constraint.b] += push.dot(problem.trees[constraint.b]->gravity);
  }
}

/// Acceleration of a tree in free fall [m/s^2]; 0 if it is supported.
Vector3 fall_of(const Problem& problem, int index) {
  if (index < 0 || !problem.trees[index]->has_floating_base) return Vector3::Zero();
  const Vector3& gravity = problem.trees[index]->gravity;
  const double all = problem.time_step * problem.total_mass[index] * gravity.squaredNorm();
  return problem.carried[index] > all / 2 ? Vector3(Vector3::Zero()) : gravity;
}

/// Relative acceleration of a contact's surfaces in free fall, along the normal [m/s^2].
double pull_of(const Problem& problem, const Constraint& constraint) {
  return constraint.frame.col(0).dot(fall_of(problem, constraint.a) - fall_of(problem, constraint.b));
}

/// Velocity change of a tree by pushes along a direction, less the load that contacts held in the
/// last substep [m/s].
double push_of(const Problem& problem, int index, const Vector3& along) {
  if (index < 0 || !problem.trees[index]->has_floating_base) return 0;
  double push = 0;
  for (const Wrench& wrench : problem.trees[index]->external) push += problem.time_step * wrench.force.dot(along);
  const double held = problem.pressed[index].dot(along), left = push * held < 0 ? push + held : push;
  return left * push > 0 ? left / problem.total_mass[index] : 0;
}

/// By how much pushes let the surfaces of a contact part faster at the substep's beginning [m/s].
double kick_of(const Problem& problem, const Constraint& constraint) {
  const Vector3 normal = constraint.frame.col(0);
  return push_of(problem, constraint.a, normal) - push_of(problem, constraint.b, normal);
}

/// Separation velocity of a contact's surfaces at the substep's beginning, without pushes [m/s].
double parting_of(const Problem& problem, const Constraint& constraint) {
  double u[Constraint::most_rows];
  problem.constraint_velocity(constraint, u);
  return u[0];
}

/// When in the substep surfaces meet, and with which speed and how far apart they are at its end.
/// @param before  how fast they part at its beginning [m/s];  @param pull  and by how much faster in a second [m/s^2]
/// @return        whether they do
bool aim(const Problem& problem, Constraint& constraint, double before, double pull) {
  const double gap = std::max(0.0, constraint.gap);
  const double square = before * before - 2 * pull * gap;  // of the speed of the impact
  if (square < restitution_threshold * restitution_threshold) return false;
  const double impact = std::sqrt(square);
  if (impact <= before) return false;  // they part
  const double time = 2 * gap / (impact - before), rest = problem.time_step - time;
  if (rest <= 0) {  // not yet: nothing may hold it
    constraint.target_velocity[0] = std::min(constraint.target_velocity[0], before + problem.time_step * pull);
    return false;
  }
  const double rise = rest * (constraint.restitution * impact + rest * pull / 2);
  if (rise <= 0) return false;
  constraint.has_impact = true;
  constraint.compliance = 0;
  constraint.impact_time = time;
  constraint.target_gap = rise;
  constraint.restitution_velocity = -impact - rest * pull;
  constraint.target_velocity[0] = constraint.restitution * impact + rest * pull;
  return true;
}

/// A push that is small beside the speed acts throughout, as gravity does; a larger one throws at the substep's beginning. What
/// touches already is pressed by it.
void aim(const Problem& problem, Constraint& constraint) {
  const double before = parting_of(problem, constraint), pull = pull_of(problem, constraint);
  const double kick = constraint.gap > touching_gap ? kick_of(problem, constraint) : 0;
  if (kick != 0 && std::abs(kick) < -before && aim(problem, constraint, before, pull + kick / problem.time_step)) return;
  aim(problem, constraint, before + kick, pull);
}

/// Whether a contact still has an impact after an earlier one has rebounded: a ball on a plate does
/// not reach the floor below that.
bool is_met_after(const Problem& problem, const Constraint& later, const Constraint& earlier) {
  if (is_large(problem, earlier)) return true;
  const double own = response(problem, earlier, earlier), cross = response(problem, earlier, later);
  if (!(own > 0) || cross <= 0) return true;
  double now[Constraint::most_rows], impact[Constraint::most_rows];
  problem.constraint_velocity(later, now);
  problem.constraint_velocity(earlier, impact);
  const double change = cross / own * (earlier.target_velocity[0] - impact[0]);
  return later.gap + earlier.impact_time * now[0] + (problem.time_step - earlier.impact_time) * (now[0] + change) < 0;
}

/// Whether a contact holds something up: what strikes that strikes all that is below it, too.
bool holds_up(const Problem& problem, const Constraint& constraint) {
  constexpr double share = 0.01;  // of the weight
  if (!may_carry(problem, constraint)) return false;
  const auto is_on = [&](int index) {
    if (index < 0) return false;
    const Vector3& gravity = problem.trees[index]->gravity;
    const double weight = problem.time_step * problem.total_mass[index] * gravity.squaredNorm();
    return constraint.impulse[0] * std::abs(constraint.frame.col(0).dot(gravity)) > share * weight;
  };
  return is_on(constraint.a) || is_on(constraint.b);
}

/// Whether an impact pushes what another constraint holds.
bool disturbs(const Problem& problem, const Constraint& impact, const Constraint& held) {
  constexpr double slight = 1e-3;  // of what it does to itself
  const double cross = std::abs(response(problem, impact, held));
  return cross > (held.kind == Constraint::Kind::contact ? slight * response(problem, impact, impact) : 0);
}

/// The impacts of an island whose bodies may strike each other in turn: single points of what nothing holds against them. None: it has
/// others, too, or hardly any.
std::vector<RestitutionContact> impacts_in_turn(Problem& problem) {
  constexpr std::size_t most = 32;
  std::vector<RestitutionContact> out;
  std::vector<const Constraint*> others;
  bool any = false;
  for (Constraint& constraint : problem.constraints) {
    const bool rebounds = constraint.kind == Constraint::Kind::contact && constraint.restitution > 0;
    if (!rebounds || holds_up(problem, constraint)) {
      others.push_back(&constraint);
      continue;
    }
    const auto is_of_the_same_face = [&](const RestitutionContact& other) {
      return other.constraint->a == constraint.a && other.constraint->b == constraint.b && other.constraint->frame.col(0) == constraint.frame.col(0);
    };
    if (out.size() == most || std::ranges::any_of(out, is_of_the_same_face) || is_large(problem, constraint)) return {};
    out.push_back({&constraint, parting_of(problem, constraint) + kick_of(problem, constraint), pull_of(problem, constraint)});
    any |= constraint.gap + problem.time_step * (out.back().speed + problem.time_step * out.back().pull) < 0;
  }
  if (!any || out.size() < 2) return {};
  for (const RestitutionContact& impact : out) {
    if (std::ranges::any_of(others, [&](const Constraint* held) { return disturbs(problem, *impact.constraint, *held); })) return {};
  }
  return out;
}

/// Lets contacts with restitution seek the speeds with which they rebound, and end where they do.
void aim_rebounds(Problem& problem) {
  const auto rebounds = [](const Constraint& constraint) { return constraint.restitution > 0; };
  if (std::ranges::none_of(problem.constraints, rebounds)) return;
  find_carried(problem);
  const std::vector<RestitutionContact> impacts = impacts_in_turn(problem);
  if (!impacts.empty() && resolve_in_time_order(problem, impacts)) return;
  for (Constraint& constraint : problem.constraints) {
    if (rebounds(constraint)) aim(problem, constraint);
  }
  if (problem.constraints.size() > most_blocks) return;
  for (Constraint& constraint : problem.constraints) {
    const auto hides_it = [&](const Constraint& other) {
      const auto shares = [&](int tree) { return tree >= 0 && (tree == constraint.a || tree == constraint.b); };
      const bool is_later = constraint.restitution_velocity * (other.impact_time - constraint.impact_time) > touching_gap;  // flat faces are not so exactly flat
      return other.has_impact && is_later && (shares(other.a) || shares(other.b)) && !is_met_after(problem, constraint, other);
    };
    if (!constraint.has_impact || std::ranges::none_of(problem.constraints, hides_it)) continue;
    constraint.has_impact = false;
    constraint.target_velocity[0] = -constraint.gap / problem.time_step;
  }
}

/// Gives restitution to contacts that close within the substep by motors, pushes or other impacts:
/// from the closing velocity without these contacts, from the beginning on.
/// @param problem  solved
/// @return         whether it must be solved again
bool aim_what_is_thrown(Problem& problem, VelocitySolver& solver) {
  std::vector<Constraint*> thrown;
  for (Constraint& constraint : problem.constraints) {
    const bool rebounds = constraint.kind == Constraint::Kind::contact && constraint.restitution > 0 && !constraint.has_impact;
    if (!rebounds || constraint.impulse[0] == 0 || constraint.gap <= restitution_threshold * problem.time_step) continue;
    thrown.push_back(&constraint);
  }
  if (thrown.empty()) return false;
  for (Constraint* constraint : thrown) {
    constraint->law = Constraint::Law::off;
    constraint->impulse.fill(0);
  }
  solver.solve(problem);
  for (Constraint* constraint : thrown) {
    constraint->law = Constraint::Law::contact;
    double u[Constraint::most_rows];
    problem.constraint_velocity(*constraint, u);
    const double time = u[0] < -restitution_threshold ? -constraint->gap / u[0] : HUGE_VAL, rest = problem.time_step - time;
    if (rest <= 0) continue;
    constraint->has_impact = true;
    constraint->compliance = 0;
    constraint->impact_time = time;
    constraint->restitution_velocity = u[0];
    constraint->target_velocity[0] = -constraint->restitution * u[0];
    constraint->target_gap = rest * constraint->target_velocity[0];
  }
  return true;
}

}  // namespace

SolverResult solve_velocities(Problem& problem, VelocitySolver& solver) {
  aim_rebounds(problem);
  problem.bound_penetration();
  constexpr int most_turns = 3;  // of limits: what is set in motion within the substep may pass the bound that is farther away
  SolverResult outcome = solver.solve(problem);
  const auto solve_again = [&] {
    const int iterations = outcome.iterations;
    outcome = solver.solve(problem);
    outcome.iterations += iterations;
  };
  for (int i = 0; i < most_turns && problem.switch_limits(); ++i) solve_again();
  if (!problem.has_sequential_impacts && aim_what_is_thrown(problem, solver)) solve_again();
  return outcome;
}

}  // namespace ziggurat::dynamics
