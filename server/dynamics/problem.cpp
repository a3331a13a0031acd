#include "dynamics/problem.h"

#include <algorithm>
#include <cmath>

#include "dynamics/free_motion.h"

namespace ziggurat::dynamics {
namespace {

/// No load presses surfaces in farther, and no more is pushed out in a substep [m].
constexpr double deepest = 1e-7;

/// A contact's normal moves by less than this where a coordinate moves by a unit: it is across the way [1], [m].
constexpr double across = 1e-9;

/// A right-handed frame whose first column is the normal.
Matrix3 frame_about(const Vector3& normal) {
  int least = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::abs(normal[k]) < std::abs(normal[least])) least = k;
  }
  Matrix3 frame;
  frame.col(0) = normal;
  frame.col(1) = normal.cross(Vector3::Unit(least)).normalized();
  frame.col(2) = normal.cross(frame.col(1));
  return frame;
}

/// Whether a limit's lower bound is the one that its joint may reach within a substep: the one that it
/// passes at its speed, or else the nearer one.
bool comes_to_lower(const Limit& limit, double q, double speed, double length) {
  const double end = q + length * speed;
  if (end < limit.lower || end > limit.upper) return end < limit.lower;
  return q - limit.lower < limit.upper - q;
}

/// Whether any coordinate moves the sides of a contact along its normal.
bool moves_along(const Problem& problem, const Block& block) {
  const auto moves = [&](int place, int first, std::span<const int> dofs) {
    if (place < 0) return false;
    if (problem.trees[place]->free_root) return true;
    return std::ranges::any_of(dofs, [&](int k) { return std::abs(problem.jacobian[first + k * block.rows]) > across; });
  };
  return moves(block.a, block.ja, block.dofs_a) || moves(block.b, block.jb, block.dofs_b);
}

/// Whether a link turns by enough that the ways of its points bend.
bool turns(const Tree& tree, double length) {
  constexpr double least = 1e-6;  // [rad]
  return std::ranges::any_of(tree.motion, [&](const Motion& motion) {
    return motion.angular.squaredNorm() * length * length > least * least;
  });
}

/// Whether a link turns so far in a substep that its speeds do not say where its points end.
bool turns_far(const Motion& motion, double length) {
  constexpr double most = 0.2;  // [rad]
  return motion.angular.squaredNorm() * length * length > most * most;
}

}  // namespace

void Problem::clear() {
  trees.clear();
  offset.clear();
  mass.clear();
  mass_offset.clear();
  drift.clear();
  bending.clear();
  blocks.clear();
  jacobian.clear();
  momentum.clear();
  inverse_mass.clear();
  total_mass.clear();
  weight = 0;
  in_turn = false;
  bias.clear();
  first_bias.clear();
  velocity.clear();
  couplings.clear();
}

void Problem::add(Tree& tree, Workspace& work, bool is_driven) {
  const int first = static_cast<int>(momentum.size());
  trees.push_back(&tree);
  offset.push_back(first);
  momentum.resize(first + tree.dofs);
  compute_mass(tree, work);
  momentum_after(tree, work, length, is_driven,
                 {momentum.data() + first, static_cast<std::size_t>(tree.dofs)});
  for (int k = 0; k < tree.dofs; ++k) inverse_mass.push_back(1 / work.mass[k * tree.dofs + k]);
  first_bias.push_back(-1);
  if (several && turns(tree, length)) {
    first_bias.back() = static_cast<int>(bias.size());
    bias_accelerations(tree, work);
    bias.insert(bias.end(), work.acceleration.begin(), work.acceleration.end());
  }
  double total = 0;
  for (const Link& link : tree.links) total += link.mass;
  total_mass.push_back(total);
  weight += total * tree.gravity.norm();
  mass_offset.push_back(static_cast<int>(mass.size()));
  mass.insert(mass.end(), work.mass.begin(), work.mass.end());
  drift.push_back(work.drift);
  bending.push_back(work.bending);
  velocity.insert(velocity.end(), tree.v.begin(), tree.v.end());
}

/// Adds columns of zeros for a tree.
/// @return  where they begin in the Jacobian
int Problem::add_columns(const Tree& tree, int rows) {
  const int first = static_cast<int>(jacobian.size());
  jacobian.resize(jacobian.size() + static_cast<std::size_t>(tree.dofs) * rows, 0.0);
  return first;
}

/// Adds the columns of a contact on one side.
/// @return  where they begin in the Jacobian
int Problem::add_rows(const Tree& tree, int link, const Vector3& point, const Block& block,
                      double sign) {
  const int rows = block.rows, first = add_columns(tree, rows);
  const Matrix3 frame = sign * block.frame;
  const Vector3 arm = point - tree.origin;
  const std::span<const int> dofs = tree.dofs_of(link);
  const std::size_t root = tree.free_root ? 6 : 0;  // dofs along the world's axes
  for (const int k : dofs.subspan(root)) {
    const Motion& axis = tree.axes[k];
    double* column = jacobian.data() + first + k * rows;
    const Vector3 speed = axis.linear + axis.angular.cross(arm);
    column[0] = frame.col(0).dot(speed);
    for (int r = 1; r < std::min(rows, 3); ++r) column[r] = frame.col(r).dot(speed);
    for (int r = 3; r < rows; ++r) column[r] = frame.col(r - 3).dot(axis.angular);
  }
  for (int r = 0; r < rows && root > 0; ++r) {
    const Vector3 direction = frame.col(r % 3);
    const Vector3 moment = r < 3 ? Vector3(arm.cross(direction)) : direction;
    double* row = jacobian.data() + first + r;
    for (int k = 0; k < 3; ++k) {
      row[k * rows] = moment[k];
      if (r < 3) row[(3 + k) * rows] = direction[k];
    }
  }
  return first;
}

/// About what a unit impulse changes of the speeds, as if the dofs did not couple; equal for the
/// rows that friction treats alike.
void Problem::weigh(Block& block) const {
  block.mobility.fill(0);
  const auto add_side = [&](int place, int first, std::span<const int> dofs) {
    if (place < 0) return;
    const double* inverse = inverse_mass.data() + offset[place];
    by_rows(block.rows, [&](auto rows) {
      constexpr int R = rows();
      const double* columns = jacobian.data() + first;
      double sum[R];
      std::copy_n(block.mobility.data(), R, sum);
      const auto add = [&](int k) {
        for (int r = 0; r < R; ++r) {
          sum[r] += columns[k * R + r] * columns[k * R + r] * inverse[k];
        }
      };
      const bool leading = leads(dofs);
      for (int k = 0; k < 6 && leading; ++k) add(k);
      for (std::size_t e = leading ? 6 : 0; e < dofs.size(); ++e) add(dofs[e]);
      std::copy_n(sum, R, block.mobility.data());
    });
  };
  add_side(block.a, block.ja, block.dofs_a);
  add_side(block.b, block.jb, block.dofs_b);
  for (int r = 1; r < block.rows; r += r == 3 ? 1 : 2) {
    if (r == 3) continue;  // turning about the normal is alone
    block.mobility[r] = block.mobility[r + 1] = (block.mobility[r] + block.mobility[r + 1]) / 2;
  }
  for (int r = 0; r < block.rows; ++r) block.mobility[r] = std::max(block.mobility[r], 1e-12);
}

/// By how much a link's velocity at a point of contact changes in a second while the speeds of all coordinates stay [m/s^2].
/// @param tree  its place in the island
Vector3 Problem::bend(int tree, int link, const Vector3& point, const Contact& contact) const {
  const Motion& motion = trees[tree]->motion[link];
  if (first_bias[tree] < 0 || (turns_far(motion, length) && !contact.rolls)) return Vector3::Zero();
  const Motion& spatial = bias[first_bias[tree] + link];
  const Vector3 arm = point - trees[tree]->origin;
  const Vector3 with_it = motion.linear + motion.angular.cross(arm);
  return spatial.linear + spatial.angular.cross(arm) + motion.angular.cross(contact.rolls ? contact.velocity : with_it);
}

/// What a contact that does not rebound seeks. Surfaces that are pressed together give way like stiff springs,
/// all of a pair alike: so contacts that are more than needed share a load by how far each is pressed in.
/// How rigid ones share it depends on all that came before.
void Problem::press(Block& block) const {
  block.seek[0] = -block.gap / length;
  if (softness == 0) {
    block.seek[0] = std::min(0.0, block.seek[0]);
    return;
  }
  const auto inverse = [&](int place) { return place >= 0 ? 1 / total_mass[place] : 0; };
  block.seek[0] = std::min(deepest / length, block.seek[0]);
  if (block.gap > 0 && block.impulse[0] == 0) return;  // an impact is stopped at the surface
  block.yield = softness * (inverse(block.a) + inverse(block.b));
  if (weight > 0) block.yield = std::min(block.yield, deepest / (length * length * weight));
}

/// Lets what touches stay together where both sides turn: by half of what their points part faster by within the substep while all
/// coordinates keep their speeds. The normal turns with the side whose face it is, or with both.
void Problem::turn_together(Block& block, const Contact& contact) const {
  if (first_bias[block.a] < 0 && first_bias[block.b] < 0) return;
  const LinkIndex sides[] = {contact.a, contact.b};
  const Vector3 points[] = {contact.point, contact.point + contact.until_met};
  const int places[] = {block.a, block.b};
  Vector3 faster = Vector3::Zero(), speed = Vector3::Zero(), turning = Vector3::Zero();  // of a less b; of both
  for (int i = 0; i < 2; ++i) {
    const Tree& tree = *trees[places[i]];
    const Motion& motion = tree.motion[sides[i].link];
    const double sign = i == 0 ? 1 : -1;
    faster += sign * bend(places[i], sides[i].link, points[i], contact);
    speed += sign * (motion.linear + motion.angular.cross(points[i] - tree.origin));
    turning += motion.angular;
  }
  for (int r = 1; r < std::min(block.rows, 3); ++r) block.seek[r] = -length / 2 * block.frame.col(r).dot(faster);
  const auto far = [&](int i) { return turns_far(trees[places[i]]->motion[sides[i].link], length); };
  const bool rebounds = contact.restitution > 0;  // then impacts have an order of their own, and energy its bound
  if (rebounds || (!contact.rolls && (far(0) || far(1)))) return;
  const Vector3 normal = block.frame.col(0);
  const Vector3 normal_turns = contact.rolls ? contact.face_turning.cross(normal) : Vector3(turning.cross(normal));
  block.bend = normal.dot(faster) + normal_turns.dot(speed);
  const double alone = std::max(0.0, block.seek[0]);
  block.seek[0] -= length / 2 * block.bend;
  if (block.impulse[0] == 0 && !contact.rolls) block.seek[0] = std::min(block.seek[0], alone);  // whose face an impact is on is not known
}

void Problem::add(const Contact& contact, int a, int b, int source) {
  Block& block = blocks.emplace_back();
  block.law = Block::Law::contact;
  const bool turns = contact.rolling > 0 || contact.spinning > 0;
  block.rows = turns ? 6 : contact.friction > 0 ? 3 : 1;
  block.a = a;
  block.b = b;
  block.friction = contact.friction;
  block.spinning = contact.spinning;
  block.rolling = contact.rolling;
  const Block* other = blocks.size() > 1 ? &blocks[blocks.size() - 2] : nullptr;
  const bool same = other && other->frame.col(0) == contact.normal;
  block.frame = same ? other->frame : frame_about(contact.normal);
  if (a >= 0) {
    block.ja = add_rows(*trees[a], contact.a.link, contact.point, block, 1);
    block.dofs_a = trees[a]->dofs_of(contact.a.link);
  }
  if (b >= 0) {
    block.jb = add_rows(*trees[b], contact.b.link, contact.point + contact.until_met, block, -1);
    block.dofs_b = trees[b]->dofs_of(contact.b.link);
  }
  weigh(block);
  block.kind = Block::Source::contact;
  block.source = source;
  block.gap = contact.gap;
  if (!moves_along(*this, block)) {  // what cannot come nearer presses with any impulse, and friction with it: with none
    block.law = Block::Law::off;
    return;
  }
  const Vector3 impulse = block.frame.transpose() * contact.impulse;
  const Vector3 angular = block.frame.transpose() * contact.angular_impulse;
  block.impulse[0] = std::max(0.0, impulse[0]);
  for (int r = 1; r < std::min(block.rows, 3); ++r) block.impulse[r] = impulse[r];
  for (int r = 3; r < block.rows; ++r) block.impulse[r] = angular[r - 3];
  press(block);
  if (a >= 0 && b >= 0) turn_together(block, contact);
  block.restitution = contact.restitution;
  if (a >= 0 && b >= 0 && a != b) {
    const std::pair<int, int> pair(std::min(a, b), std::max(a, b));
    if (couplings.empty() || couplings.back() != pair) couplings.push_back(pair);
  }
}

void Problem::add(const Servo& servo, int place, int source) {
  const Tree& tree = *trees[place];
  Block& block = blocks.emplace_back();
  block.law = Block::Law::bounded;
  block.rows = 1;
  block.a = place;
  block.ja = add_columns(tree, 1);
  if (servo.dof >= 0) {
    jacobian[block.ja + servo.dof] = 1;
    block.dofs_a = tree.dof_alone(servo.dof);
  } else {
    const Vector3 arm = tree.position[servo.link] - tree.origin;
    block.dofs_a = tree.dofs_of(servo.link);
    for (const int k : block.dofs_a) {
      const Motion& axis = tree.axes[k];
      jacobian[block.ja + k] = servo.direction.angular.dot(axis.angular) +
                               servo.direction.linear.dot(axis.linear + axis.angular.cross(arm));
    }
  }
  weigh(block);
  block.seek[0] = servo.speed;
  block.lower = servo.lower;
  block.upper = servo.upper;
  block.impulse[0] = std::clamp(servo.impulse, servo.lower, servo.upper);
  block.source = source;
  block.kind = Block::Source::servo;
}

void Problem::add(const Limit& limit, int place, int source) {
  const Tree& tree = *trees[place];
  const int dof = joint_dof(tree, limit.link);
  const double q = tree.q[tree.first_place[limit.link]];
  const bool at_lower = comes_to_lower(limit, q, tree.v[dof], length);
  Block& block = blocks.emplace_back();
  block.law = Block::Law::bounded;
  block.rows = 1;
  block.a = place;
  block.ja = add_columns(tree, 1);
  jacobian[block.ja + dof] = at_lower ? 1 : -1;
  block.dofs_a = tree.dof_alone(dof);
  weigh(block);
  block.gap = at_lower ? q - limit.lower : limit.upper - q;
  block.range = limit.upper - limit.lower;
  block.seek[0] = block.gap > 0 ? -block.gap / length : 0;
  block.upper = std::numeric_limits<double>::infinity();
  block.impulse[0] = std::max(0.0, at_lower ? limit.impulse : -limit.impulse);
  block.source = source;
  block.kind = Block::Source::limit;
}

namespace {

/// u += the columns of a side times the speeds of its dofs, of R rows.
template <int R>
void add_speeds(const double* columns, std::span<const int> dofs, const double* v, double* u) {
  double sum[R] = {};
  const auto add = [&](int k) {
    for (int r = 0; r < R; ++r) sum[r] += columns[k * R + r] * v[k];
  };
  const bool leading = leads(dofs);
  for (int k = 0; k < 6 && leading; ++k) add(k);
  for (std::size_t e = leading ? 6 : 0; e < dofs.size(); ++e) add(dofs[e]);
  for (int r = 0; r < R; ++r) u[r] += sum[r];
}

}  // namespace

void Problem::speeds(const Block& block, double* u, const double* v) const {
  const double* j = jacobian.data();
  by_rows(block.rows, [&](auto rows) {
    for (int r = 0; r < rows(); ++r) u[r] = 0;
    if (block.a >= 0) add_speeds<rows()>(j + block.ja, block.dofs_a, v + offset[block.a], u);
    if (block.b >= 0) add_speeds<rows()>(j + block.jb, block.dofs_b, v + offset[block.b], u);
  });
}

bool Problem::turn_limits() {
  constexpr double rounding = 1e-9;  // [m], [rad]
  bool any = false;
  for (Block& block : blocks) {
    if (block.kind != Block::Source::limit) continue;
    double speed = 0;
    speeds(block, &speed);
    if (block.gap + length * speed <= block.range + rounding) continue;
    double& direction = jacobian[block.ja + block.dofs_a[0]];
    direction = -direction;
    block.gap = block.range - block.gap;
    block.seek[0] = -std::max(0.0, block.gap) / length;
    block.impulse[0] = 0;
    any = true;
  }
  return any;
}

void Problem::bound_depth() {
  double depth = 0;
  for (const Block& block : blocks) depth = std::max(depth, block.yield * block.impulse[0] * length);
  if (depth <= deepest) return;
  for (Block& block : blocks) block.yield *= deepest / depth;
}

void Problem::harden() {
  for (Block& block : blocks) {
    if (block.yield == 0) continue;
    block.yield = 0;
    block.seek[0] = std::min(0.0, block.seek[0] + length / 2 * block.bend) - length / 2 * block.bend;
  }
}

double Problem::gap_after(const Block& block) const {
  double u[Block::most_rows];
  speeds(block, u);
  return block.gap + length * (u[0] + length / 2 * block.bend);
}

bool Problem::two_stay_in() const {
  return std::ranges::any_of(blocks, [&](const Block& block) {
    return block.a >= 0 && block.b >= 0 && overlaps(block) && gap_after(block) < -allowed_overlap;
  });
}

bool Problem::turn_into_displacement() {
  const auto bounces = [&](const Block& block) { return rebounded(block); };
  const bool rebounding = std::ranges::any_of(blocks, bounces);
  if (!rebounding && std::ranges::none_of(blocks, [&](const Block& block) { return overlaps(block); })) return false;
  const auto holds = [&](const Block& block) {  // through the impact: what it holds did not move when it was struck
    return rebounding && (block.kind == Block::Source::servo ? block.is_obeyed() : block.impulse[0] > 0);
  };
  for (Block& block : blocks) {
    if (block.law == Block::Law::off) continue;
    if (block.kind == Block::Source::servo && !holds(block)) {
      block.law = Block::Law::off;
      block.impulse.fill(0);  // sweeps begin with what all impulses do
      continue;
    }
    const double after = gap_after(block);
    const bool bounced = bounces(block), both_ways = bounced || holds(block);
    block.law = Block::Law::bounded;
    block.lower = both_ways ? -std::numeric_limits<double>::infinity() : 0;
    block.upper = std::numeric_limits<double>::infinity();
    if (block.kind == Block::Source::servo) {
      block.seek[0] = 0;
    } else if (bounced) {  // it turned round at the surface, not at the substep's beginning
      block.seek[0] = block.rise - after;
    } else {  // overlaps go four fifths a substep; the last micrometre stays
      block.seek[0] = block.gap < 0 ? -0.8 * std::min(0.0, after + allowed_overlap) : -after;
    }
    block.yield = 0;
    block.impulse.fill(0);
  }
  std::fill(momentum.begin(), momentum.end(), 0.0);
  std::fill(velocity.begin(), velocity.end(), 0.0);
  return true;
}

void Problem::leave_rebounds() {
  for (Block& block : blocks) {
    block.impulse.fill(0);
    if (!block.bounces || block.lower == 0) continue;
    block.lower = 0;
    block.seek[0] -= block.rise;
  }
  std::fill(velocity.begin(), velocity.end(), 0.0);
}

}  // namespace ziggurat::dynamics
