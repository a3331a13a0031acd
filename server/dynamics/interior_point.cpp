// The interior point method for islands that strike: impulses and speeds of every contact stay
// inside their cones, and the product of both goes to zero. The number of its steps hardly depends
// on how many contacts there are and which of them hold, stick or slide.
//
// A contact's impulse z = (mu g_n, g_t) and speed s = (u_n / mu + |u_t|, u_t) lie in the cone
// x_0 >= |(x_1, x_2)| and have the product 0 where Coulomb's law holds: the term |u_t| is what
// keeps sliders from lifting off (G. de Saxce, Z.-Q. Feng, Math. Comput. Modelling 28, 1998). Steps
// are those of Nesterov and Todd with Mehrotra's corrector (L. Vandenberghe, The CVXOPT linear and
// quadratic cone program solvers, 2010, sections 4 and 5), but with the derivative of |u_t|, which
// makes the matrix unsymmetric: without it convergence is linear and slow.

#include <algorithm>
#include <cmath>

#include "dynamics/newton.h"
#include "dynamics/constraint_hessian.h"

namespace ziggurat::dynamics {
namespace {

constexpr double compliance = 1e-8;  // of all impulses, over the mobility
constexpr double share = 0.95;       // of the way to the border of the cones
constexpr double least_centering = 1e-4;
constexpr double least_friction = 1e-4;

double tangential(const Vector3& x) { return std::sqrt(x[1] * x[1] + x[2] * x[2]); }

/// x_0^2 - x_1^2 - x_2^2
double square(const Vector3& x) {
  const double t = tangential(x);
  return (x[0] - t) * (x[0] + t);
}

/// The Jordan product of the cone.
Vector3 product(const Vector3& a, const Vector3& b) {
  return {a[0] * b[0] + a[1] * b[1] + a[2] * b[2], a[0] * b[1] + b[0] * a[1],
          a[0] * b[2] + b[0] * a[2]};
}

/// x with product(a, x) = b.
Vector3 quotient(const Vector3& a, const Vector3& b) {
  const double x = (a[0] * b[0] - a[1] * b[1] - a[2] * b[2]) / square(a);
  return {x, (b[1] - x * a[1]) / a[0], (b[2] - x * a[2]) / a[0]};
}

/// How many times d leads from x to the border of the cone, at most 1.
double way_to_border(const Vector3& x, const Vector3& d) {
  const double a = d[0] * d[0] - d[1] * d[1] - d[2] * d[2];
  const double b = x[0] * d[0] - x[1] * d[1] - x[2] * d[2];
  const double c = std::max(0.0, square(x));
  double way = d[0] < 0 ? std::min(1.0, -x[0] / d[0]) : 1;
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return way;
  const double q = -(b + (b > 0 ? 1 : -1) * std::sqrt(discriminant));
  if (a != 0 && q / a > 0) way = std::min(way, q / a);
  if (q != 0 && c / q > 0) way = std::min(way, c / q);
  return way;
}

double way_to_zero(double x, double d) { return d < 0 ? std::min(1.0, -x / d) : 1; }

bool is_cone(const Block& block) { return block.law == Block::Law::contact && block.rows >= 3; }

/// Rows that the method solves for; those of rolling and spinning friction keep their impulses.
int solved_rows(const Block& block) {
  return block.law == Block::Law::off ? 0 : is_cone(block) ? 3 : 1;
}

/// Scaling of Nesterov and Todd, and what the speed gives of the impulse: dz = -slope A dv.
void scale_cone(InteriorBlock& c) {
  const double ns = std::sqrt(square(c.speed)), nz = std::sqrt(square(c.impulse));
  const Vector3 s = c.speed / ns, z = c.impulse / nz;
  const double cosine = s[0] * z[0] + s[1] * z[1] + s[2] * z[2];
  const double gamma = 2 * std::sqrt((1 + cosine) / 2);
  const Vector3 w((s[0] + z[0]) / gamma, (s[1] - z[1]) / gamma, (s[2] - z[2]) / gamma);
  const double stretch = ns / nz, root = std::sqrt(stretch), rest = 1 / (1 + w[0]);
  Matrix3 squared;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double one = i == j ? 1 : 0;
      squared(i, j) = stretch * (2 * w[i] * w[j] + (i == 0 ? -one : one));
      const double entry = i == 0 ? w[j] : j == 0 ? w[i] : one + w[i] * w[j] * rest;
      c.scaling(i, j) = root * entry;
      c.unscaling(i, j) = ((i == 0) == (j == 0) ? entry : -entry) / root;
    }
  }
  c.point = c.scaling * c.impulse;
  const double slip = tangential(c.speed);
  c.lift = slip > 0 ? Vector3(0, c.speed[1] / slip, c.speed[2] / slip) : Vector3::Zero();
  Matrix3 lifted = squared;
  lifted.row(0) -= c.lift.transpose() * squared;
  for (int i = 0; i < 3; ++i) lifted(i, i) += c.give[i];
  c.slope = lifted.inverse();
}

/// What the change of a block's impulse starts from, where its product is to become `target`.
/// @param corrects  whether the change before is taken into account
void aim_at(const Block& block, double target, bool corrects, InteriorBlock& c) {
  if (is_cone(block)) {
    Vector3 wanted = -product(c.point, c.point);
    wanted[0] += target;
    if (corrects) {
      wanted -= product(Vector3(c.unscaling * c.speed_change), Vector3(c.scaling * c.change));
    }
    c.aim = c.scaling * quotient(c.point, wanted);
    c.constant = c.aim - c.residual;
    c.constant[0] -= c.lift.dot(c.aim);
    return;
  }
  c.constant[0] = -c.residual[0];
  if (c.at_lower > 0) c.constant[0] += target / (c.impulse[0] - c.lower);
  if (c.at_upper > 0) c.constant[0] -= target / (c.upper - c.impulse[0]);
}

/// |u_t| is convex, so it grows by at least as much as its derivative told. What it grows by more
/// is added to the speed's first part: that leads deeper into the cone, and no step leaves a residual
/// that is large beside the products. Such residuals stopped the method in heaps that strike.
void advance_speed(double way, InteriorBlock& c) {
  const double slip = tangential(c.speed), told = c.lift.dot(c.speed_change);
  c.speed += way * c.speed_change;
  c.speed[0] += std::max(0.0, tangential(c.speed) - slip - way * told);
}

}  // namespace

/// Puts impulses and speeds inside their bounds.
/// @param margin  [m/s]
void Solver::enter(const Problem& problem, double margin) {
  interior_.assign(problem.blocks.size(), InteriorBlock{});
  for (std::size_t k = 0; k < problem.blocks.size(); ++k) {
    const Block& block = problem.blocks[k];
    InteriorBlock& c = interior_[k];
    if (block.law == Block::Law::off) continue;
    double u[Block::most_rows];
    problem.speeds(block, u);
    if (is_cone(block)) {
      const double mu = std::max(block.friction, least_friction);
      c.unit = Vector3(1 / mu, 1, 1);
      const Vector3 mobility(block.mobility[0], block.mobility[1], block.mobility[2]);
      c.give = compliance * mobility.cwiseProduct(c.unit).cwiseProduct(c.unit);
      c.impulse = Vector3(block.impulse[0] * mu, block.impulse[1], block.impulse[2]);
      c.anchor = c.impulse;
      c.speed = Vector3((u[0] - block.seek[0]) / mu, u[1] - block.seek[1], u[2] - block.seek[2]);
      c.speed[0] = std::max(c.speed[0], 0.0) + tangential(c.speed) + margin / mu;
      c.impulse[0] =
          std::max(c.impulse[0], tangential(c.impulse)) + mu * margin / block.mobility[0];
      continue;
    }
    // An impulse between bounds; speeds beyond the one sought belong to the bounds.
    const double inside = margin / block.mobility[0];
    const double lower = block.law == Block::Law::contact ? 0 : block.lower;
    const double upper = block.law == Block::Law::contact ? HUGE_VAL : block.upper;
    const double room = std::min(inside, (upper - lower) / 4);
    c.lower = lower, c.upper = upper;
    c.unit = Vector3(1, 0, 0);
    c.give = Vector3(compliance * block.mobility[0], 0, 0);
    c.anchor = Vector3(block.impulse[0], 0, 0);
    c.impulse = Vector3(std::clamp(block.impulse[0], lower + room, upper - room), 0, 0);
    const double over = u[0] - block.seek[0];
    c.at_lower = lower == -HUGE_VAL ? 0 : std::max(over, 0.0) + margin;
    c.at_upper = upper == HUGE_VAL ? 0 : std::max(-over, 0.0) + margin;
  }
}

/// Linearises all blocks, with the matrix and the residuals.
/// @return  the mean product of impulse and speed [J]
double Solver::linearise_interior(Problem& problem) {
  start_matrix(problem, matrix_);
  double products = 0;
  int count = 0;
  for (std::size_t k = 0; k < problem.blocks.size(); ++k) {
    const Block& block = problem.blocks[k];
    InteriorBlock& c = interior_[k];
    Linear& linear = linear_[k];
    linear.zero = block.law == Block::Law::off;
    if (linear.zero) continue;
    double u[Block::most_rows];
    problem.speeds(block, u);
    const double over = c.unit[0] * (u[0] - block.seek[0]);
    const int rows = block.rows, solved = solved_rows(block);
    if (solved == 3) {
      scale_cone(c);
      c.residual = Vector3(over + tangential(c.speed), u[1] - block.seek[1], u[2] - block.seek[2]) +
                   c.give.cwiseProduct(c.impulse - c.anchor) - c.speed;
      products += c.impulse.dot(c.speed);
      ++count;
    } else {
      double stiffness = c.give[0];
      if (c.at_lower > 0) {
        const double room = c.impulse[0] - c.lower;
        stiffness += c.at_lower / room, products += c.at_lower * room, ++count;
      }
      if (c.at_upper > 0) {
        const double room = c.upper - c.impulse[0];
        stiffness += c.at_upper / room, products += c.at_upper * room, ++count;
      }
      c.slope(0, 0) = 1 / stiffness;
      c.residual[0] = over + c.give[0] * (c.impulse[0] - c.anchor[0]);
    }
    std::fill_n(linear.slope.begin(), rows * rows, 0.0);
    for (int r = 0; r < solved; ++r) {
      for (int s = 0; s < solved; ++s) {
        linear.slope[r * rows + s] = c.unit[r] * c.slope(r, s) * c.unit[s];
      }
    }
    add_slope(problem, block, linear, sloped_, matrix_);
  }
  return products / std::max(1, count);
}

/// The direction to products of `target`, in direction_ and the blocks' changes.
/// @param corrects  whether the changes of the direction before are taken into account
/// @return          how far it goes before one of the impulses or speeds leaves its bounds
double Solver::interior_direction(Problem& problem, double target, bool corrects) {
  direction_ = residual_;
  for (std::size_t k = 0; k < problem.blocks.size(); ++k) {
    const Block& block = problem.blocks[k];
    InteriorBlock& c = interior_[k];
    if (block.law == Block::Law::off) continue;
    aim_at(block, target, corrects, c);
    double g[Block::most_rows] = {};
    for (int r = 0; r < solved_rows(block); ++r) {
      for (int s = 0; s < solved_rows(block); ++s) {
        g[r] += c.unit[r] * c.slope(r, s) * c.constant[s];
      }
    }
    add_impulse(problem, block, g, direction_);
  }
  matrix_.solve(direction_.data());
  std::swap(problem.velocity, direction_);
  double way = 1;
  for (std::size_t k = 0; k < problem.blocks.size(); ++k) {
    const Block& block = problem.blocks[k];
    InteriorBlock& c = interior_[k];
    if (block.law == Block::Law::off) continue;
    double u[Block::most_rows];
    problem.speeds(block, u);
    if (is_cone(block)) {
      c.change = c.slope * (c.constant - Vector3(c.unit[0] * u[0], u[1], u[2]));
      c.speed_change = c.aim - c.scaling * Vector3(c.scaling * c.change);
      way = std::min(
          {way, way_to_border(c.impulse, c.change), way_to_border(c.speed, c.speed_change)});
      continue;
    }
    const double change = c.slope(0, 0) * (c.constant[0] - u[0]);
    c.change[0] = change;
    if (c.at_lower > 0) {
      const double room = c.impulse[0] - c.lower;
      c.lower_change = (target - c.at_lower * change) / room - c.at_lower;
      way = std::min({way, way_to_zero(room, change), way_to_zero(c.at_lower, c.lower_change)});
    }
    if (c.at_upper > 0) {
      const double room = c.upper - c.impulse[0];
      c.upper_change = (target + c.at_upper * change) / room - c.at_upper;
      way = std::min({way, way_to_zero(room, -change), way_to_zero(c.at_upper, c.upper_change)});
    }
  }
  std::swap(problem.velocity, direction_);
  return way;
}

/// The mean product after a part of the way.
double Solver::product_after(const Problem& problem, double way) const {
  double products = 0;
  int count = 0;
  for (std::size_t k = 0; k < problem.blocks.size(); ++k) {
    const InteriorBlock& c = interior_[k];
    if (problem.blocks[k].law == Block::Law::off) continue;
    if (is_cone(problem.blocks[k])) {
      products += (c.impulse + way * c.change).dot(c.speed + way * c.speed_change), ++count;
      continue;
    }
    const double impulse = c.impulse[0] + way * c.change[0];
    if (c.at_lower > 0) {
      products += (impulse - c.lower) * (c.at_lower + way * c.lower_change), ++count;
    }
    if (c.at_upper > 0) {
      products += (c.upper - impulse) * (c.at_upper + way * c.upper_change), ++count;
    }
  }
  return products / std::max(1, count);
}

/// Goes along the direction.
void Solver::advance_interior(Problem& problem, double way) {
  for (std::size_t i = 0; i < direction_.size(); ++i) problem.velocity[i] += way * direction_[i];
  for (std::size_t k = 0; k < problem.blocks.size(); ++k) {
    Block& block = problem.blocks[k];
    InteriorBlock& c = interior_[k];
    if (block.law == Block::Law::off) continue;
    c.impulse += way * c.change;
    if (is_cone(block)) advance_speed(way, c);
    if (c.at_lower > 0) c.at_lower += way * c.lower_change;
    if (c.at_upper > 0) c.at_upper += way * c.upper_change;
    for (int r = 0; r < solved_rows(block); ++r) block.impulse[r] = c.unit[r] * c.impulse[r];
  }
}

/// @return  whether the miss became small enough; otherwise the problem holds the best state met
bool Solver::interior_points(Problem& problem, Outcome& outcome) {
  // From no impulses: those of the last substep may hold each other up to any size.
  for (Block& block : problem.blocks) {
    for (int r = 0; r < solved_rows(block); ++r) block.impulse[r] = 0;
  }
  double scale = 0, best = HUGE_VAL;
  take_speeds(problem);
  miss_now(problem, scale);
  const double pushed = imbalance(problem, residual_);
  snapshot_.take(problem);
  if (!(scale + pushed > 0)) return false;
  enter(problem, std::max(0.1 * scale, pushed));
  for (int i = 0; i < options.most_interior; ++i) {
    ++outcome.interior;
    imbalance(problem, residual_);
    const double product = linearise_interior(problem);
    if (!matrix_.factor()) break;
    const double straight = interior_direction(problem, 0, false);
    const double left = std::clamp(product_after(problem, straight) / product, 0.0, 1.0);
    const double centering = std::max(left * left * left, least_centering);
    const double way = interior_direction(problem, centering * product, straight > 0.1);
    advance_interior(problem, std::min(1.0, share * way));
    take_speeds(problem);
    outcome.miss = miss_now(problem, scale);
    if (!std::isfinite(outcome.miss)) break;
    if (outcome.miss < best) {
      best = outcome.miss;
      snapshot_.take(problem);
    }
    if (outcome.miss <= options.absolute_tolerance + options.soft_tolerance * scale) return true;
  }
  snapshot_.give_back(problem);
  outcome.miss = best;
  return false;
}

}  // namespace ziggurat::dynamics
