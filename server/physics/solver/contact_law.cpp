#include "physics/solver/contact_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ziggurat::dynamics {
namespace {

constexpr double least_compliance = 1e-8;  // of held rows, over the mobility

/// Friction discs: first row, dimension, bound over the normal impulse.
struct FrictionDisc {
  int first, size;
  double ratio;
};

/// @return  how many
int friction_discs(const Constraint& constraint, FrictionDisc* out) {
  if (constraint.law != Constraint::Law::contact || constraint.rows == 1) return 0;
  out[0] = {1, 2, constraint.friction};
  if (constraint.rows == 3) return 1;
  out[1] = {3, 1, constraint.spinning_friction};
  out[2] = {4, 2, constraint.rolling_friction};
  return 3;
}

void linearise_held(const Constraint& constraint, int row, LinearisedLaw& out) {
  const double stiffness = 1 / (least_compliance * constraint.mobility[row]);
  out.hessian[row * constraint.rows + row] = stiffness;
  out.constant[row] = constraint.impulse[row] + stiffness * constraint.target_velocity[row];
}

void linearise_normal(const Constraint& constraint, LinearisedLaw& out) {
  if (constraint.compliance == 0) return linearise_held(constraint, 0, out);
  out.hessian[0] = 1 / constraint.compliance;
  out.constant[0] = constraint.target_velocity[0] / constraint.compliance;
}

/// Linearises friction within a disc: it sticks, or slides with its whole bound against the slip.
/// @param normal  part of y, > 0
void linearise(const Constraint& constraint, const FrictionDisc& disc, const double* y, LinearisedLaw& out) {
  const double bound = disc.ratio * y[0];
  double square = 0;
  for (int r = 0; r < disc.size; ++r) square += y[disc.first + r] * y[disc.first + r];
  if (square <= bound * bound) {
    for (int r = 0; r < disc.size; ++r) linearise_held(constraint, disc.first + r, out);
    return;
  }
  const double length = std::sqrt(square);
  double direction[2] = {};
  for (int r = 0; r < disc.size; ++r) direction[r] = y[disc.first + r] / length;
  const int rows = constraint.rows;
  for (int r = 0; r < disc.size; ++r) {
    const int row = disc.first + r;
    out.constant[row] = disc.ratio * direction[r] * out.constant[0];
    out.hessian[row * rows] = disc.ratio * direction[r] * out.hessian[0];
  }
  if (disc.size < 2 || bound <= 0) return;
  // Across the slip the direction of friction turns with the velocity.
  const double mobility = constraint.mobility[disc.first];
  const double across = std::min(bound / (length - bound), 1 / least_compliance) / mobility;
  for (int r = 0; r < 2; ++r) {
    for (int c = 0; c < 2; ++c) {
      const double projection = (r == c ? 1 : 0) - direction[r] * direction[c];
      const int row = disc.first + r, column = disc.first + c;
      out.hessian[row * rows + column] += across * projection;
      out.constant[row] += across * projection * constraint.target_velocity[column];
    }
  }
}

void project_impulse(const Constraint& constraint, double* y) {
  if (constraint.law == Constraint::Law::bounded) {
    y[0] = std::clamp(y[0], constraint.lower, constraint.upper);
    return;
  }
  y[0] = constraint.law == Constraint::Law::contact ? std::max(0.0, y[0]) : 0;
  FrictionDisc all[3];
  const int count = friction_discs(constraint, all);
  for (int d = 0; d < count; ++d) {
    const FrictionDisc& disc = all[d];
    const double bound = disc.ratio * y[0];
    double square = 0;
    for (int r = 0; r < disc.size; ++r) square += y[disc.first + r] * y[disc.first + r];
    if (square <= bound * bound) continue;
    const double factor = bound / std::sqrt(square);
    for (int r = 0; r < disc.size; ++r) y[disc.first + r] *= factor;
  }
}

int active_rows(const Constraint& constraint) {
  return constraint.law == Constraint::Law::contact ? constraint.rows : constraint.law == Constraint::Law::bounded ? 1 : 0;
}

/// A contact with sliding friction only: most are so.
bool is_plain(const Constraint& constraint) { return constraint.rows == 3 && constraint.law == Constraint::Law::contact; }

/// The projection's argument y of one row, see contact_law.h.
double projection_argument(const Constraint& constraint, const double* u, int row) {
  const double give_way = row == 0 ? constraint.compliance * constraint.impulse[0] : 0;
  return constraint.impulse[row] - (u[row] + give_way - constraint.target_velocity[row]) / constraint.mobility[row];
}

void linearise_plain(const Constraint& constraint, const double* u, LinearisedLaw& out) {
  const double normal = projection_argument(constraint, u, 0);
  out.is_zero = normal <= 0;
  if (out.is_zero) return;
  const double y[2] = {projection_argument(constraint, u, 1), projection_argument(constraint, u, 2)};
  const double* target = constraint.target_velocity.data() + 1;
  auto& hessian = out.hessian;
  auto& constant = out.constant;
  hessian[1] = hessian[2] = 0;
  linearise_normal(constraint, out);
  const double bound = constraint.friction * normal, square = y[0] * y[0] + y[1] * y[1];
  if (square <= bound * bound) {
    const double held = 1 / (least_compliance * constraint.mobility[1]);  // both tangents have the same mobility
    hessian[3] = hessian[5] = hessian[6] = hessian[7] = 0;
    hessian[4] = hessian[8] = held;
    constant[1] = constraint.impulse[1] + held * target[0];
    constant[2] = constraint.impulse[2] + held * target[1];
    return;
  }
  const double length = std::sqrt(square);
  const double direction[2] = {y[0] / length, y[1] / length};
  // Across the slip the direction of friction turns with the velocity.
  const double across =
      bound > 0 ? std::min(bound / (length - bound), 1 / least_compliance) / constraint.mobility[1] : 0;
  for (int r = 0; r < 2; ++r) {
    const double share = constraint.friction * direction[r];
    const double along = across * ((r == 0) - direction[r] * direction[0]);
    const double beside = across * ((r == 1) - direction[r] * direction[1]);
    hessian[3 + 3 * r] = share * hessian[0];
    hessian[4 + 3 * r] = along;
    hessian[5 + 3 * r] = beside;
    constant[1 + r] = share * constant[0] + along * target[0] + beside * target[1];
  }
}

/// Residual of a contact without normal impulse: all its impulses should be zero.
double residual_without_normal(const Constraint& constraint) {
  double worst = 0;
  for (int r = 0; r < constraint.rows; ++r) {
    worst = std::max(worst, std::abs(constraint.impulse[r]) * constraint.mobility[r]);
  }
  return worst;
}

/// Error of the impulses of a contact with plain friction: g - P(y).
/// @param normal  part of y, > 0
std::array<double, 3> plain_law_error(const Constraint& constraint, const double* u, double normal) {
  double y[2] = {projection_argument(constraint, u, 1), projection_argument(constraint, u, 2)};
  const double bound = constraint.friction * normal, square = y[0] * y[0] + y[1] * y[1];
  if (square > bound * bound) {
    const double factor = bound / std::sqrt(square);
    y[0] *= factor, y[1] *= factor;
  }
  const auto& g = constraint.impulse;
  return {g[0] - normal, g[1] - y[0], g[2] - y[1]};
}

double plain_residual(const Constraint& constraint, const double* u, double normal) {
  const auto wrong = plain_law_error(constraint, u, normal);
  const auto& m = constraint.mobility;
  return std::max({std::abs(wrong[0]) * m[0], std::abs(wrong[1]) * m[1], std::abs(wrong[2]) * m[2]});
}

}  // namespace

void linearise(const Constraint& constraint, const double* u, LinearisedLaw& out) {
  if (is_plain(constraint)) return linearise_plain(constraint, u, out);
  const int rows = constraint.rows;
  out.is_zero = true;
  if (constraint.law == Constraint::Law::off) return;
  double y[Constraint::most_rows] = {};
  for (int r = 0; r < active_rows(constraint); ++r) y[r] = projection_argument(constraint, u, r);
  if (constraint.law == Constraint::Law::contact && y[0] <= 0) return;
  out.is_zero = false;
  std::fill_n(out.constant.begin(), rows, 0.0);
  std::fill_n(out.hessian.begin(), rows * rows, 0.0);
  if (constraint.law == Constraint::Law::bounded) {
    if (y[0] <= constraint.lower || y[0] >= constraint.upper) {
      out.constant[0] = y[0] <= constraint.lower ? constraint.lower : constraint.upper;
      out.is_zero = out.constant[0] == 0;
    } else {
      linearise_held(constraint, 0, out);
    }
    return;
  }
  linearise_normal(constraint, out);
  FrictionDisc all[3];
  const int count = friction_discs(constraint, all);
  for (int d = 0; d < count; ++d) linearise(constraint, all[d], y, out);
}

void regularise(const Constraint& constraint, const double* u, double regularisation, bool about_multipliers, double* impulse, LinearisedLaw* out) {
  const int rows = constraint.rows, active = active_rows(constraint);
  std::fill_n(impulse, rows, 0.0);
  if (out) {
    out->is_zero = true;
    std::fill_n(out->hessian.begin(), rows * rows, 0.0);
  }
  if (active == 0) return;
  double y[Constraint::most_rows];
  for (int r = 0; r < active; ++r) {
    y[r] = (about_multipliers ? constraint.multiplier[r] : 0) - (u[r] - constraint.target_velocity[r]) / (regularisation * constraint.mobility[r]);
  }
  const auto set_hessian = [&](int row, int column, double share) {
    if (!out) return;
    out->is_zero = false;
    out->hessian[row * rows + column] = share / (regularisation * constraint.mobility[row]);
  };
  const double lower = constraint.law == Constraint::Law::bounded ? constraint.lower : 0;
  const double upper =
      constraint.law == Constraint::Law::bounded ? constraint.upper : std::numeric_limits<double>::infinity();
  const double normal_compliance = regularisation * constraint.mobility[0];
  const double share = normal_compliance / (about_multipliers ? normal_compliance + constraint.compliance : std::max(normal_compliance, constraint.compliance));
  y[0] *= share;
  impulse[0] = std::clamp(y[0], lower, upper);
  if (y[0] > lower && y[0] < upper) set_hessian(0, 0, share);
  FrictionDisc all[3];
  const int count = friction_discs(constraint, all);
  for (int d = 0; d < count; ++d) {
    const auto [first, size, ratio] = all[d];
    const double bound = ratio * impulse[0];
    double square = 0;
    for (int r = first; r < first + size; ++r) square += y[r] * y[r];
    if (bound == 0 && square > 0) continue;
    const double length = std::sqrt(square);
    const bool slides = length > bound;
    const double share = slides ? bound / length : 1;
    for (int r = first; r < first + size; ++r) {
      impulse[r] = share * y[r];
      if (slides && out) {
        out->hessian[r * rows] = ratio * y[r] / length * out->hessian[0];
      }
      for (int c = first; c < first + size && share > 0; ++c) {
        double entry = r == c ? share : 0;
        if (slides) entry -= share * y[r] * y[c] / square;
        set_hessian(r, c, entry);
      }
    }
  }
}

double residual(const Constraint& constraint, const double* u) {
  if (constraint.law == Constraint::Law::contact) {
    const double normal = projection_argument(constraint, u, 0);
    if (normal <= 0) return residual_without_normal(constraint);
    if (is_plain(constraint)) return plain_residual(constraint, u, normal);
  }
  const int rows = active_rows(constraint);
  double y[Constraint::most_rows];
  for (int r = 0; r < rows; ++r) y[r] = projection_argument(constraint, u, r);
  project_impulse(constraint, y);
  double worst = 0;
  for (int r = 0; r < rows; ++r) {
    worst = std::max(worst, std::abs(constraint.impulse[r] - y[r]) * constraint.mobility[r]);
  }
  return worst;
}

double merit(const Constraint& constraint, const double* u) {
  double sum = 0;
  if (is_plain(constraint)) {
    const double normal = projection_argument(constraint, u, 0);
    const std::array<double, 3> wrong = normal > 0 ? plain_law_error(constraint, u, normal)
                                                   : std::array{constraint.impulse[0], constraint.impulse[1], constraint.impulse[2]};
    for (int r = 0; r < 3; ++r) sum += wrong[r] * wrong[r] * constraint.mobility[r];
    return sum;
  }
  const int rows = active_rows(constraint);
  double y[Constraint::most_rows];
  for (int r = 0; r < rows; ++r) y[r] = projection_argument(constraint, u, r);
  project_impulse(constraint, y);
  for (int r = 0; r < rows; ++r) {
    sum += (constraint.impulse[r] - y[r]) * (constraint.impulse[r] - y[r]) * constraint.mobility[r];
  }
  return sum;
}

void project(const Constraint& constraint, double* impulse) { project_impulse(constraint, impulse); }

}  // namespace ziggurat::dynamics
