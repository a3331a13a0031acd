#include "magnetism/field.h"

#include <algorithm>
#include <cassert>

namespace ziggurat::magnetism {
namespace {

Row row(const Vector3& v, double w) { return {v.x(), v.y(), v.z(), w}; }
Vector3 vector(const Row& r) { return {r.x, r.y, r.z}; }

/// Below this distance two magnets count as this far apart: spheres cannot come closer.
double core_radius(const Magnet& magnet) {
  const auto* sphere = std::get_if<Sphere>(&magnet.shape);
  return sphere != nullptr ? sphere->radius : 0;
}

}  // namespace

Field::Field(std::vector<Magnet> magnets, std::size_t bodies, const Options& options)
    : kernel_(options.kernel != nullptr ? *options.kernel : best_kernel()),
      options_(options),
      magnets_(std::move(magnets)),
      bodies_(bodies),
      range_{options.max_distance, options.max_distance * (1 - options.taper),
             options.minimum_distance},
      neighbours_(options.max_distance),
      rotations_(bodies) {
  if (!(options.taper > 0)) range_.taper_start = range_.maximum;
  const std::size_t rows = padded_rows(magnets_.size());
  positions_.resize(rows);
  moments_.resize(rows);
  forces_.resize(rows);
  fields_.resize(rows);
  external_.resize(rows);
  for (std::size_t i = 0; i < magnets_.size(); ++i) {
    assert(magnets_[i].body < bodies);
    if (magnets_[i].freely_turning) free_.push_back(static_cast<std::uint32_t>(i));
    positions_[i].w = core_radius(magnets_[i]);
    // Pairs of one group are left out: magnets fixed to the same body, whose forces and torques on
    // it cancel. A freely turning magnet is a group of its own: its torque does not reach the body,
    // so r x F of a pair within one body does not cancel.
    moments_[i].w = magnets_[i].freely_turning ? -1 - static_cast<double>(i)
                                               : static_cast<double>(magnets_[i].body);
  }
  for (std::size_t i = magnets_.size(); i < rows; ++i) {
    moments_[i].w = -1 - static_cast<double>(i);
  }
  reset();
}

void Field::reset() {
  turns_.assign(magnets_.size(), Quaternion::Identity());
  for (const std::uint32_t i : free_) {
    const Vector3 moment = magnets_[i].passive_moment + magnets_[i].active_moment;
    if (!(moment.norm() > 0)) continue;
    const Vector3 direction = moment.normalized();
    turns_[i] = shortest_rotation(direction, tilted(direction, i));
  }
}

void Field::set_turns(std::span<const Quaternion> turns) {
  assert(turns.size() == turns_.size());
  std::copy(turns.begin(), turns.end(), turns_.begin());
}

Vector3 Field::moment(std::size_t magnet) const { return vector(moments_[magnet]); }
Vector3 Field::flux(std::size_t magnet) const { return vector(fields_[magnet]); }

void Field::evaluate(double dt, std::span<const Pose> bodies, std::span<const double> currents,
                     std::span<Wrench> wrenches) {
  assert(bodies.size() == bodies_ && wrenches.size() == bodies_);
  assert(currents.size() == magnets_.size());
  place(bodies, currents);
  neighbours_.update(dipoles());
  if (dt > 0 && !free_.empty()) turn(dt);
  std::fill(forces_.begin(), forces_.end(), Row{});
  std::fill(fields_.begin(), fields_.end(), Row{});
  if (neighbours_.listed()) {
    kernel_.pairs(dipoles(), neighbours_.pairs(), range_, {forces_.data(), fields_.data()});
  } else {
    kernel_.all_pairs(dipoles(), range_, {forces_.data(), fields_.data()});
  }
  collect(bodies, wrenches);
}

void Field::place(std::span<const Pose> bodies, std::span<const double> currents) {
  for (std::size_t b = 0; b < bodies_; ++b) {
    rotations_[b] = bodies[b].orientation.toRotationMatrix();
  }
  for (std::size_t i = 0; i < magnets_.size(); ++i) {
    const Magnet& magnet = magnets_[i];
    const Eigen::Matrix3d& rotation = rotations_[magnet.body];
    Vector3 moment = magnet.passive_moment + currents[i] * magnet.active_moment;
    if (magnet.freely_turning) moment = turns_[i] * moment;
    positions_[i] = row(bodies[magnet.body].position + rotation * magnet.position, positions_[i].w);
    moments_[i] = row(rotation * moment, moments_[i].w);
  }
}

void Field::turn(double dt) {
  if (partners_built_ != neighbours_.rebuilds()) {
    partners_built_ = neighbours_.rebuilds();
    if (neighbours_.listed()) {
      partners_.list(neighbours_.pairs(), free_, magnets_.size());
    } else {
      partners_.list_all(magnets_.size());
    }
  }
  for (const std::uint32_t i : free_) forces_[i] = moments_[i];  // as they were
  relax(kernel_, dipoles(), moments_.data(), external_.data(), free_, partners_, range_, dt,
        options_.relaxation);
  for (const std::uint32_t i : free_) {
    const Vector3 before = vector(forces_[i]);
    const double magnitude = before.norm();
    if (!(magnitude > 0)) continue;
    const Eigen::Matrix3d to_body = rotations_[magnets_[i].body].transpose();
    const Quaternion turned =
        shortest_rotation(to_body * before / magnitude, to_body * vector(moments_[i]) / magnitude);
    turns_[i] = (turned * turns_[i]).normalized();
  }
}

void Field::collect(std::span<const Pose> bodies, std::span<Wrench> wrenches) const {
  std::fill(wrenches.begin(), wrenches.end(), Wrench{});
  for (std::size_t i = 0; i < magnets_.size(); ++i) {
    const Magnet& magnet = magnets_[i];
    Wrench& wrench = wrenches[magnet.body];
    const Vector3 force = vector(forces_[i]);
    const Vector3 lever = vector(positions_[i]) - bodies[magnet.body].position;
    wrench.force += force;
    wrench.torque += lever.cross(force);
    if (!magnet.freely_turning) {
      wrench.torque += vector(moments_[i]).cross(vector(fields_[i]));
    }
  }
}

}  // namespace ziggurat::magnetism
