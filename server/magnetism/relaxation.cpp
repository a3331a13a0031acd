// SPDX-License-Identifier: MIT
#include "magnetism/relaxation.h"

#include <cmath>

#include "magnetism/elementary.h"

namespace ziggurat::magnetism {
namespace {

/// A unit vector at right angles, the same for the same vector on every machine.
Vector3 perpendicular(const Vector3& unit) {
  const Vector3 a = unit.cwiseAbs();
  const Vector3 axis = a.x() <= a.y() && a.x() <= a.z() ? Vector3::UnitX()
                       : a.y() <= a.z()                 ? Vector3::UnitY()
                                                        : Vector3::UnitZ();
  return unit.cross(axis).normalized();
}

/// Below this sine of the angle to the field a direction counts as (anti)parallel.
constexpr double smallest_sine = 1e-9;

}  // namespace

Vector3 turned(const Vector3& direction, const Vector3& field, double rate, double time) {
  const double strength = field.norm();
  if (!(strength > 0) || !std::isfinite(strength)) return direction;
  const Vector3 along = field / strength;
  double cosine = direction.dot(along);
  Vector3 across = direction - cosine * along;
  double sine = across.norm();
  if (sine < smallest_sine) {
    if (cosine > 0) return along;
    across = perpendicular(along);
    sine = smallest_sine;
  } else {
    across /= sine;
  }
  // tan(theta / 2) decays exponentially; near theta = pi by the form that does not cancel.
  const double half = cosine > 0 ? sine / (1 + cosine) : (1 - cosine) / sine;
  const double t = half * decay(rate * strength * time);
  cosine = (1 - t * t) / (1 + t * t);
  sine = 2 * t / (1 + t * t);
  return (cosine * along + sine * across).normalized();
}

Quaternion shortest_rotation(const Vector3& from, const Vector3& to) {
  const double w = 1 + from.dot(to);
  if (w < 1e-12) {
    const Vector3 axis = perpendicular(from);
    return {0, axis.x(), axis.y(), axis.z()};
  }
  const Vector3 axis = from.cross(to);
  return Quaternion(w, axis.x(), axis.y(), axis.z()).normalized();
}

Vector3 tilted(const Vector3& direction, std::size_t index) {
  // Bits well mixed (the finaliser of SplitMix64): no two indices alike.
  std::uint64_t bits = (static_cast<std::uint64_t>(index) + 1) * 0x9e3779b97f4a7c15ULL;
  bits = (bits ^ bits >> 30) * 0xbf58476d1ce4e5b9ULL;
  bits = (bits ^ bits >> 27) * 0x94d049bb133111ebULL;
  bits ^= bits >> 31;
  const auto part = [bits](int shift) {
    return static_cast<double>(bits >> shift & 0x1fffff) / 0x1fffff - 0.5;
  };
  const Vector3 random(part(0), part(21), part(42));
  Vector3 across = random - random.dot(direction) * direction;
  if (across.norm() < 1e-6) across = perpendicular(direction);
  return (direction + 1e-3 * across.normalized()).normalized();
}

void Partners::list_all(std::size_t dipoles) {
  all_ = true;
  indices_.resize(padded_rows(dipoles));
  for (std::size_t i = 0; i < indices_.size(); ++i) {
    indices_[i] = static_cast<std::uint32_t>(i < dipoles ? i : dipoles);
  }
}

void Partners::list(const Pairs& pairs, const std::vector<std::uint32_t>& free,
                    std::size_t dipoles) {
  all_ = false;
  fill_.assign(dipoles + 1, 0);
  for (const std::uint32_t i : free) fill_[i] = 1;
  starts_.assign(dipoles + 2, 0);
  for (std::size_t k = 0; k < pairs.count; ++k) {
    starts_[pairs.first[k]] += fill_[pairs.first[k]];
    starts_[pairs.second[k]] += fill_[pairs.second[k]];
  }
  std::uint32_t sum = 0;
  for (std::uint32_t& start : starts_) {
    const std::uint32_t padded = (start + 3) / 4 * 4;
    start = sum;
    sum += padded;
  }
  indices_.assign(sum, static_cast<std::uint32_t>(dipoles));
  // From here on fill_ is where the next partner of a free dipole goes; pairs are sorted, so
  // partners come in ascending order.
  for (const std::uint32_t i : free) fill_[i] += starts_[i];
  const auto add = [this](std::uint32_t to, std::uint32_t partner) {
    if (fill_[to] != 0) indices_[fill_[to]++ - 1] = partner;
  };
  for (std::size_t k = 0; k < pairs.count; ++k) {
    add(pairs.first[k], pairs.second[k]);
    add(pairs.second[k], pairs.first[k]);
  }
}

void relax(const Kernel& kernel, const Dipoles& dipoles, Row* moments, const Row* external,
           const std::vector<std::uint32_t>& free, const Partners& partners, const Range& range,
           double dt, const RelaxationOptions& options) {
  const double time = dt / options.passes;
  const auto turn = [&](std::uint32_t i) {
    const Row others = kernel.field_at(dipoles, i, partners.begin(i), partners.count(i), range);
    Row& row = moments[i];
    const Vector3 moment(row.x, row.y, row.z);
    const double magnitude = moment.norm();
    if (!(magnitude > 0)) return;
    const Vector3 field(others.x + external[i].x, others.y + external[i].y,
                        others.z + external[i].z);
    const Vector3 next =
        magnitude * turned(moment / magnitude, field, magnitude / options.friction, time);
    row = {next.x(), next.y(), next.z(), row.w};
  };
  for (unsigned pass = 0; pass < options.passes; ++pass) {
    if (pass % 2 == 0) {
      for (auto i = free.begin(); i != free.end(); ++i) turn(*i);
    } else {
      for (auto i = free.rbegin(); i != free.rend(); ++i) turn(*i);
    }
  }
}

}  // namespace ziggurat::magnetism
