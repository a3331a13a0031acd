// SPDX-License-Identifier: MIT
#include "physics/solver/contact_law.h"

namespace ziggurat::dynamics {
namespace {

constexpr double least_compliance = 1e-8;  // of held rows, over the mobility

/// The projection's argument y of one row, see contact_law.h.
double argument(const Constraint& constraint, const double* u, int row) {
  const double give_way = row == 0 ? constraint.compliance * constraint.impulse[0] : 0;
  return constraint.impulse[row] -
         (u[row] + give_way - constraint.target_velocity[row]) / constraint.mobility[row];
}

/// The projection's argument y in the rows of a disc.
struct DiscArgument {
  double y[2] = {}, square = 0;
};

DiscArgument argument(const Constraint& constraint, const double* u, const FrictionDisc& disc) {
  DiscArgument out;
  for (int r = 0; r < disc.size; ++r) {
    out.y[r] = argument(constraint, u, disc.first + r);
    out.square += out.y[r] * out.y[r];
  }
  return out;
}

/// Linearises a row that is held at its target velocity.
void linearise_held(const Constraint& constraint, int row, int rows, double stiffness,
                    LinearisedLaw& out) {
  out.hessian[row * rows + row] = stiffness;
  out.constant[row] = constraint.impulse[row] + stiffness * constraint.target_velocity[row];
}

/// Linearises friction within a disc: it sticks, or slides with its whole bound against the slip.
/// @param normal  impulse, linearised in the first row
void linearise(const Constraint& constraint, const double* u, const FrictionDisc& disc,
               double normal, int rows, LinearisedLaw& out) {
  const double mobility = constraint.mobility[disc.first];
  const auto [bound, per_normal] =
      friction_bound(disc, constraint.friction, normal, u + disc.first);
  const auto [y, square] = argument(constraint, u, disc);
  if (square <= bound * bound) {
    const double stiffness = 1 / (least_compliance * mobility);
    for (int r = 0; r < disc.size; ++r)
      linearise_held(constraint, disc.first + r, rows, stiffness, out);
    return;
  }
  const double length = std::sqrt(square), direction[] = {y[0] / length, y[1] / length};
  // Across the slip the direction of friction turns with the velocity.
  const double across = disc.size < 2 || bound <= 0
                            ? 0
                            : std::min(bound / (length - bound), 1 / least_compliance) / mobility;
  for (int r = 0; r < disc.size; ++r) {
    const int row = disc.first + r;
    const double share = per_normal * direction[r];
    out.constant[row] = share * out.constant[0] + direction[r] * (bound - per_normal * normal);
    out.hessian[row * rows] = share * out.hessian[0];
    for (int c = 0; c < disc.size; ++c) {
      const double entry = across * ((r == c ? 1 : 0) - direction[r] * direction[c]);
      out.hessian[row * rows + disc.first + c] = entry;
      out.constant[row] += entry * constraint.target_velocity[disc.first + c];
    }
  }
}

/// Linearises R acting rows.
template <int R>
void linearise_rows(const Constraint& constraint, const double* u, LinearisedLaw& out) {
  const int rows = R == 1 ? constraint.rows : R;  // without impulses in the others
  const double y = argument(constraint, u, 0),
               normal = std::clamp(y, constraint.lower, constraint.upper);
  const bool is_saturated = normal <= constraint.lower || normal >= constraint.upper;
  out.is_zero = is_saturated && normal == 0;
  if (out.is_zero) return;
  for (int k = 0; k < rows; ++k) out.constant[k] = 0;
  for (int k = 0; k < rows * rows; ++k) out.hessian[k] = 0;
  if (is_saturated) {
    out.constant[0] = normal;
  } else if (constraint.compliance > 0) {
    out.hessian[0] = 1 / constraint.compliance;
    out.constant[0] = constraint.target_velocity[0] / constraint.compliance;
  } else {
    linearise_held(constraint, 0, rows, 1 / (least_compliance * constraint.mobility[0]), out);
  }
  for (int d = 0; d < R / 2; ++d) linearise(constraint, u, friction_discs[d], normal, rows, out);
}

/// Calls visit with the row and the error g - P(y) of each of R acting rows.
template <int R, class Visit>
void visit_errors(const Constraint& constraint, const double* u, Visit visit) {
  const double normal = std::clamp(argument(constraint, u, 0), constraint.lower, constraint.upper);
  visit(0, constraint.impulse[0] - normal);
  for (int d = 0; d < R / 2; ++d) {
    const FrictionDisc& disc = friction_discs[d];
    const double bound = friction_bound(disc, constraint.friction, normal, u + disc.first).value;
    const auto [y, square] = bound == 0 ? DiscArgument{} : argument(constraint, u, disc);
    const double share = friction_share(bound, square);
    for (int r = 0; r < disc.size; ++r)
      visit(disc.first + r, constraint.impulse[disc.first + r] - share * y[r]);
  }
}

}  // namespace

void set_law(const ContactPoint& contact, Constraint& constraint) {
  constraint.kind = Constraint::Kind::contact;
  constraint.law = Constraint::Law::contact;
  constraint.friction = {contact.friction, contact.spinning_friction, contact.rolling_friction};
  const bool turns = contact.rolling_friction > 0 || contact.spinning_friction > 0;
  constraint.rows = turns ? 6 : contact.friction > 0 ? 3 : 1;
}

void set_law(const Servo& servo, Constraint& constraint) {
  constraint.kind = Constraint::Kind::servo;
  constraint.law = Constraint::Law::bounded;
  constraint.rows = 1;
  constraint.lower = servo.lower;
  constraint.upper = servo.upper;
}

void set_law(const Limit&, Constraint& constraint) {
  constraint.kind = Constraint::Kind::limit;
  constraint.law = Constraint::Law::bounded;
  constraint.rows = 1;
}

void linearise(const Constraint& constraint, const double* u, LinearisedLaw& out) {
  out.is_zero = true;
  if (constraint.law == Constraint::Law::off) return;
  dispatch_rows(acting_rows(constraint),
                [&](auto rows) { linearise_rows<rows()>(constraint, u, out); });
}

void regularise(const Constraint& constraint, const double* u, double regularisation,
                bool about_multipliers, double* impulse, LinearisedLaw* out) {
  const int rows = constraint.rows, acting = acting_rows(constraint);
  std::fill_n(impulse, rows, 0.0);
  if (out) {
    out->is_zero = true;
    std::fill_n(out->hessian.begin(), rows * rows, 0.0);
  }
  if (acting == 0) return;
  double y[Constraint::most_rows];
  for (int r = 0; r < acting; ++r) {
    y[r] = (about_multipliers ? constraint.multiplier[r] : 0) -
           (u[r] - constraint.target_velocity[r]) / (regularisation * constraint.mobility[r]);
  }
  const auto set_hessian = [&](int row, int column, double share) {
    if (!out) return;
    out->is_zero = false;
    out->hessian[row * rows + column] = share / (regularisation * constraint.mobility[row]);
  };
  const double normal_compliance = regularisation * constraint.mobility[0];
  const double normal_share =
      normal_compliance / (about_multipliers ? normal_compliance + constraint.compliance
                                             : std::max(normal_compliance, constraint.compliance));
  y[0] *= normal_share;
  impulse[0] = std::clamp(y[0], constraint.lower, constraint.upper);
  if (y[0] > constraint.lower && y[0] < constraint.upper) set_hessian(0, 0, normal_share);
  for (const FrictionDisc& disc : discs_of(acting)) {
    const int first = disc.first, size = disc.size;
    const auto [bound, per_normal] =
        friction_bound(disc, constraint.friction, impulse[0], u + first);
    double square = 0;
    for (int r = first; r < first + size; ++r) square += y[r] * y[r];
    const double length = std::sqrt(square), share = friction_share(bound, square);
    for (int r = first; r < first + size && share > 0; ++r) {
      impulse[r] = share * y[r];
      if (share < 1 && out) out->hessian[r * rows] = per_normal * y[r] / length * out->hessian[0];
      for (int c = first; c < first + size; ++c) {
        double entry = r == c ? share : 0;
        if (share < 1) entry -= share * y[r] * y[c] / square;
        set_hessian(r, c, entry);
      }
    }
  }
}

double residual(const Constraint& constraint, const double* u) {
  double worst = 0;
  if (constraint.law == Constraint::Law::off) return worst;
  dispatch_rows(acting_rows(constraint), [&](auto rows) {
    visit_errors<rows()>(constraint, u, [&](int r, double error) {
      worst = std::max(worst, std::abs(error) * constraint.mobility[r]);
    });
  });
  return worst;
}

double merit(const Constraint& constraint, const double* u) {
  double sum = 0;
  if (constraint.law == Constraint::Law::off) return sum;
  dispatch_rows(acting_rows(constraint), [&](auto rows) {
    visit_errors<rows()>(
        constraint, u, [&](int r, double error) { sum += error * error * constraint.mobility[r]; });
  });
  return sum;
}

}  // namespace ziggurat::dynamics
