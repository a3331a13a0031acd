// SPDX-License-Identifier: MIT
#include "magnetism/field.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "magnetism/row.h"

namespace ziggurat::magnetism {
namespace {

/// Below the sum of two of these the magnets count as this far apart: spheres cannot come closer.
double core_radius(const Magnet& magnet) {
  const auto* sphere = std::get_if<Sphere>(&magnet.shape);
  return sphere != nullptr ? std::max(sphere->radius, magnet.core) : magnet.core;
}

}  // namespace

void PairSet::assign(std::span<const MagnetPair> pairs) {
  first_.clear();
  second_.clear();
  magnets_.clear();
  for (const auto& [first, second] : pairs) {
    first_.push_back(first);
    second_.push_back(second);
    magnets_.insert(magnets_.end(), {first, second});
  }
  std::sort(magnets_.begin(), magnets_.end());
  magnets_.erase(std::unique(magnets_.begin(), magnets_.end()), magnets_.end());
}

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
    body_of_.push_back(magnets_[i].body);
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
  if (options.precision == Precision::adaptive) {
    std::vector<Shape> shapes;
    std::vector<Quaternion> orientations;
    for (const Magnet& magnet : magnets_) {
      shapes.push_back(magnet.freely_turning ? Shape(PointShape{}) : magnet.shape);
      orientations.push_back(magnet.orientation);
    }
    shapes_.emplace(shapes, orientations, options.tolerance);
    torques_.resize(rows);
    if (shapes_->reach() > 0) {
      near_.emplace(std::min(shapes_->reach(), options.max_distance));
    } else {
      shapes_.reset();
    }
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

Vector3 Field::position(std::size_t magnet) const { return vector(positions_[magnet]); }
Vector3 Field::moment(std::size_t magnet) const { return vector(moments_[magnet]); }

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
  if (shapes_) {
    std::fill(torques_.begin(), torques_.end(), Row{});
    visit_near_pairs([this](std::size_t i, std::size_t j) { add_interaction_of_shapes(i, j); });
  }
  collect(bodies, wrenches);
}

void Field::evaluate(PairSet& pairs, std::span<const Pose> bodies, std::span<const double> currents,
                     std::span<Wrench> wrenches) {
  for (const std::uint32_t i : pairs.magnets_) {
    const std::uint32_t body = magnets_[i].body;
    rotations_[body] = bodies[body].orientation.toRotationMatrix();
    place(i, bodies[body], currents[i]);
    forces_[i] = fields_[i] = Row{};
    if (shapes_) torques_[i] = Row{};
    wrenches[body] = {};
  }
  const std::size_t count = pairs.first_.size();
  const auto nothing = static_cast<std::uint32_t>(magnets_.size());
  pairs.first_.resize((count + 3) / 4 * 4, nothing);
  pairs.second_.resize(pairs.first_.size(), nothing);
  kernel_.pairs(dipoles(), {pairs.first_.data(), pairs.second_.data(), pairs.first_.size()}, range_,
                {forces_.data(), fields_.data()});
  pairs.first_.resize(count);
  pairs.second_.resize(count);
  for (std::size_t k = 0; shapes_ && k < count; ++k) {
    const std::size_t i = pairs.first_[k], j = pairs.second_[k];
    if (is_near(i, j)) add_interaction_of_shapes(i, j);
  }
  for (const std::uint32_t i : pairs.magnets_) {
    collect(i, bodies[magnets_[i].body], wrenches[magnets_[i].body]);
  }
}

void Field::list_near(double reach, std::vector<MagnetPair>& out) {
  out.clear();
  const double limit = std::min(reach, range_.maximum);
  const auto consider = [&](std::uint32_t i, std::uint32_t j) {
    const Row& a = positions_[i];
    const Row& b = positions_[j];
    const double x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
    if (x * x + y * y + z * z <= limit * limit && magnets_[i].body != magnets_[j].body) {
      out.emplace_back(i, j);
    }
  };
  const Neighbours* list = &neighbours_;
  if (!list->listed()) {
    if (!close_ || close_reach_ != limit) close_.emplace(close_reach_ = limit);
    close_->update(dipoles());
    list = &*close_;
  }
  const auto count = static_cast<std::uint32_t>(magnets_.size());
  if (list->listed()) {
    const Pairs pairs = list->pairs();
    for (std::size_t k = 0; k < pairs.count && pairs.first[k] < count; ++k) {
      consider(pairs.first[k], pairs.second[k]);
    }
    return;
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::uint32_t j = i + 1; j < count; ++j) consider(i, j);
  }
}

/// Whether a pair needs more than dipoles.
bool Field::is_near(std::size_t first, std::size_t second) const {
  const Row& a = positions_[first];
  const Row& b = positions_[second];
  const double x = a.x - b.x;
  const double y = a.y - b.y;
  const double z = a.z - b.z;
  const double reach =
      std::min(std::max(shapes_->reach(first), shapes_->reach(second)), range_.maximum);
  return x * x + y * y + z * z < reach * reach;
}

/// Calls visit(i, j), i < j, in order for all pairs that need more than dipoles.
template <class Visit>
void Field::visit_near_pairs(const Visit& visit) {
  const auto consider = [&](std::size_t i, std::size_t j) {
    if (is_near(i, j)) visit(i, j);
  };
  const Neighbours* list = &neighbours_;
  if (!list->listed()) {
    near_->update(dipoles());
    list = &*near_;
  }
  if (list->listed()) {
    const Pairs pairs = list->pairs();
    for (std::size_t k = 0; k < pairs.count && pairs.first[k] < magnets_.size(); ++k) {
      consider(pairs.first[k], pairs.second[k]);
    }
  } else {
    for (std::size_t i = 0; i < magnets_.size(); ++i) {
      for (std::size_t j = i + 1; j < magnets_.size(); ++j) {
        if (moments_[i].w != moments_[j].w) consider(i, j);
      }
    }
  }
}

double Field::fade(double distance) const {
  if (distance <= range_.taper_start) return 1;
  const double u = (distance - range_.taper_start) / (range_.maximum - range_.taper_start);
  return 1 - u * u * u * (10 - 15 * u + 6 * (u * u));
}

void Field::add_interaction_of_shapes(std::size_t first, std::size_t second) {
  const Vector3 r = vector(positions_[first]) - vector(positions_[second]);
  const double minimum = std::max(range_.minimum, positions_[first].w + positions_[second].w);
  const Interaction extra =
      shapes_->beyond_dipoles(kernel_, dipoles(), first, second, rotations_[body_of_[first]],
                              rotations_[body_of_[second]], minimum);
  const double factor = fade(r.norm());
  const auto add = [factor](Row& to, const Vector3& term) {
    to = row(vector(to) + factor * term, to.w);
  };
  add(forces_[first], extra.force_on_first);
  add(forces_[second], -extra.force_on_first);
  add(torques_[first], extra.torque_on_first);
  add(torques_[second], extra.torque_on_second);
}

void Field::add_field_of_shapes(std::size_t first, std::size_t second) {
  const auto add = [this](std::size_t free, std::size_t source) {
    if (!magnets_[free].freely_turning || magnets_[source].freely_turning) return;
    const Vector3 at = vector(positions_[free]);
    const Vector3 r = at - vector(positions_[source]);
    const double minimum = std::max(range_.minimum, positions_[free].w + positions_[source].w);
    const Vector3 exact =
        shapes_->field(kernel_, dipoles(), source, rotations_[magnets_[source].body], at);
    const Vector3 dipole = dipole_field(vector(moments_[source]), r, minimum);
    external_[free] = row(vector(external_[free]) + fade(r.norm()) * (exact - dipole), 0);
  };
  add(first, second);
  add(second, first);
}

void Field::place(std::span<const Pose> bodies, std::span<const double> currents) {
  for (std::size_t b = 0; b < bodies_; ++b) {
    rotations_[b] = bodies[b].orientation.toRotationMatrix();
  }
  for (std::size_t i = 0; i < magnets_.size(); ++i) {
    place(i, bodies[magnets_[i].body], currents[i]);
  }
}

void Field::place(std::size_t i, const Pose& body, double current) {
  const Magnet& magnet = magnets_[i];
  const Eigen::Matrix3d& rotation = rotations_[magnet.body];
  Vector3 moment = magnet.passive_moment + current * magnet.active_moment;
  if (magnet.freely_turning) moment = turns_[i] * moment;
  positions_[i] = row(body.position + rotation * magnet.position, positions_[i].w);
  moments_[i] = row(rotation * moment, moments_[i].w);
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
  if (shapes_) {
    std::fill(external_.begin(), external_.end(), Row{});
    visit_near_pairs([this](std::size_t i, std::size_t j) { add_field_of_shapes(i, j); });
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
    collect(i, bodies[magnets_[i].body], wrenches[magnets_[i].body]);
  }
}

void Field::collect(std::size_t i, const Pose& body, Wrench& wrench) const {
  const Vector3 force = vector(forces_[i]);
  const Vector3 lever = vector(positions_[i]) - body.position;
  wrench.force += force;
  wrench.torque += lever.cross(force);
  if (!magnets_[i].freely_turning) {
    wrench.torque += vector(moments_[i]).cross(vector(fields_[i]));
    if (shapes_) wrench.torque += vector(torques_[i]);
  }
}

}  // namespace ziggurat::magnetism
