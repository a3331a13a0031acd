// SPDX-License-Identifier: MIT
#include "physics/stiff_magnets.h"

#include <algorithm>
#include <cmath>

namespace ziggurat::physics {
namespace {

using math::Vector3;

/// Below this product of rate and substep a pair never matters: what it does in a substep is as
/// good as constant.
constexpr double soft = 0.005;
/// The pairs of a body must not misplace more than this share of a bond's energy in a substep.
constexpr double share = 1e-4;
/// Needs below this part of the bound count for the sum, but are not divided.
constexpr double least_part = 0.1;
/// Bounds of products of rate and length of a part. For a body: the root of the sum of squares of
/// its pairs, each times the share of the bond energy that is left. For a pair: the largest.
constexpr double part_angle = 0.2, largest_angle = 0.1;
constexpr int most_parts = 128;

/// Motion of a carrier at a point, now and a substep ago.
struct PointMotion {
  Vector3 now, before;
};

PointMotion motion_at(const Carrier& carrier, const Vector3& point) {
  const Vector3 arm = point - carrier.centre;
  return {carrier.velocity + carrier.turning.cross(arm),
          carrier.velocity_before + carrier.turning_before.cross(arm)};
}

/// Inverse mass felt by a force at a point [1/kg].
double felt_inverse_mass(const Carrier& carrier, const Vector3& point) {
  return carrier.inverse_mass + (point - carrier.centre).squaredNorm() * carrier.inverse_inertia;
}

/// Bounds of a pair's force and torque at a distance, for any directions of its moments. With them
/// the rate at which it swings or falls together is bounded.
struct Stiffness {
  double force, torque;                  // [N], [N m]
  double inverse_mass, inverse_inertia;  // of both [1/kg], [1/(kg m^2)]
  double rate;                           // [rad/s]

  Stiffness(const PairOfMagnets& pair, const Carrier& a, const Carrier& b, double distance)
      : torque(2 * magnetism::magnetic_constant * pair.moments / (distance * distance * distance)),
        inverse_mass(felt_inverse_mass(a, pair.first) + felt_inverse_mass(b, pair.second)),
        inverse_inertia(a.inverse_inertia + b.inverse_inertia) {
    force = 3 * torque / distance;  // the energy is -torque
    rate = std::sqrt(4 * force / distance * inverse_mass + torque * inverse_inertia);
  }
};

}  // namespace

double close_reach(double moment, double inverse_mass, double inverse_inertia, double substep) {
  const double energy = 2 * magnetism::magnetic_constant * moment * moment;  // times 1 m^3
  const double rate = soft / substep;
  return std::max(std::pow(24 * energy * inverse_mass / (rate * rate), 0.2),
                  std::cbrt(4 * energy * inverse_inertia / (rate * rate)));
}

std::optional<Need> need_of(const PairOfMagnets& pair, const Carrier& a, const Carrier& b,
                            double substep, std::uint64_t now) {
  const Stiffness at_d(pair, a, b, pair.distance);
  if (!(substep * at_d.rate > soft)) return {};
  if (a.rests && b.rests) return Need{};
  const Vector3 middle = (pair.first + pair.second) / 2;
  const PointMotion at_a = motion_at(a, middle), at_b = motion_at(b, middle);
  double speed = (at_a.now - at_b.now).norm();
  double turning = (a.turning - b.turning).norm();
  // Constraints of both, contacts as well, decide by how much they will speed up.
  const auto known = [now](const Carrier& c) {
    const bool seen = c.seen_before > 0 && c.seen_before + 1 == now;
    return c.inverse_mass == 0 || seen;
  };
  if (known(a) && known(b)) {
    speed += (at_a.now - at_a.before - at_b.now + at_b.before).norm();
    turning += (a.turning - a.turning_before - b.turning + b.turning_before).norm();
  } else {
    speed += substep * at_d.force * at_d.inverse_mass;
    turning += substep * at_d.torque * at_d.inverse_inertia;
  }
  const double closest = pair.closest > 0 ? std::min(pair.closest, pair.distance) : pair.distance;
  const double bond = Stiffness(pair, a, b, closest).torque;
  Need need;
  // A substep takes the force at its beginning: half a substep's change of energy is misplaced.
  need.misplaced = substep / 2 * (at_d.force * speed + at_d.torque * turning) / bond;
  if (need.misplaced <= least_part * share) return need;
  const double nearest =
      std::max(pair.distance - substep * speed, std::min(closest, pair.distance / 2));
  const Stiffness at_nearest(pair, a, b, nearest);
  const double angle = substep * std::max({at_nearest.rate, speed / nearest, turning});
  // A part misplaces energy to second order.
  need.parts_squared = angle * angle * at_nearest.torque / bond / (part_angle * part_angle);
  need.fewest_parts = angle / largest_angle;
  return need;
}

Need& Need::operator+=(const Need& other) {
  misplaced += other.misplaced;
  parts_squared += other.parts_squared;
  fewest_parts = std::max(fewest_parts, other.fewest_parts);
  return *this;
}

int parts_for(const Need& need, const Carrier& a, const Carrier& b) {
  const double around = std::max(a.need.misplaced, b.need.misplaced);
  if (need.misplaced <= least_part * share || around <= share) return 0;
  const double parts = std::max({std::sqrt(std::max(a.need.parts_squared, b.need.parts_squared)),
                                 a.need.fewest_parts, b.need.fewest_parts});
  return static_cast<int>(std::clamp(std::ceil(parts), 1.0, static_cast<double>(most_parts)));
}

}  // namespace ziggurat::physics
