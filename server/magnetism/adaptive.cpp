// SPDX-License-Identifier: MIT
#include "magnetism/adaptive.h"

#include <algorithm>

#include "magnetism/exact_field.h"
#include "magnetism/row.h"

namespace ziggurat::magnetism {
namespace {

/// The tolerance is shared between the levels' own errors and the step where they meet.
constexpr double share = 0.8;

bool same_shape(const Shape& a, const Shape& b) {
  if (a.index() != b.index()) return false;
  if (const auto* box = std::get_if<Box>(&a)) return box->size == std::get<Box>(b).size;
  if (const auto* cylinder = std::get_if<Cylinder>(&a)) {
    const auto& other = std::get<Cylinder>(b);
    return cylinder->radius == other.radius && cylinder->height == other.height;
  }
  return true;  // points and spheres are all dipoles
}

std::size_t padded(std::size_t count) { return (count + 3) / 4 * 4; }

PaddedRule pad(const Rule& rule) {
  PaddedRule result{{}, {}, {}, {}, padded(rule.points.size()), rule.centre_weight};
  const auto add = [&result](const Vector3& point, double weight) {
    result.x.push_back(point.x());
    result.y.push_back(point.y());
    result.z.push_back(point.z());
    result.weight.push_back(weight);
  };
  for (std::size_t k = 0; k < rule.points.size(); ++k) add(rule.points[k], rule.weights[k]);
  while (result.x.size() < result.shell) add(Vector3::Zero(), 0);
  add(Vector3::Zero(), rule.centre_weight);
  while (result.x.size() % 4 != 0) add(Vector3::Zero(), 0);
  return result;
}

Points points(const PaddedRule& rule, std::size_t count, const Eigen::Matrix3d& axes) {
  return {rule.x.data(),
          rule.y.data(),
          rule.z.data(),
          rule.weight.data(),
          count,
          {axes(0, 0), axes(0, 1), axes(0, 2), axes(1, 0), axes(1, 1), axes(1, 2), axes(2, 0),
           axes(2, 1), axes(2, 2)}};
}

/// With the centre.
Points whole(const PaddedRule& rule, const Eigen::Matrix3d& axes) {
  return points(rule, rule.x.size(), axes);
}

/// Without it.
Points shell(const PaddedRule& rule, const Eigen::Matrix3d& axes) {
  return points(rule, rule.shell, axes);
}

Vector3 at(const Points& p, std::size_t k) {
  return {p.axes[0] * p.x[k] + p.axes[1] * p.y[k] + p.axes[2] * p.z[k],
          p.axes[3] * p.x[k] + p.axes[4] * p.y[k] + p.axes[5] * p.z[k],
          p.axes[6] * p.x[k] + p.axes[7] * p.y[k] + p.axes[8] * p.z[k]};
}

}  // namespace

ShapedMagnets::ShapedMagnets(const std::vector<Shape>& shapes,
                             const std::vector<math::Quaternion>& orientations, double tolerance)
    : tolerance_(tolerance) {
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const auto found = std::find_if(classes_.begin(), classes_.end(), [&](const ShapeClass& known) {
      return same_shape(known.shape, shapes[i]);
    });
    class_of_.push_back(static_cast<std::uint32_t>(found - classes_.begin()));
    turned_.push_back(orientations[i].toRotationMatrix());
    is_turned_.push_back(turned_.back() != Eigen::Matrix3d::Identity());
    if (found != classes_.end()) continue;
    classes_.push_back({shapes[i], pad(coarse_rule(shapes[i])), pad(fine_rule(shapes[i])),
                        magnetism::reach(shapes[i], share * tolerance)});
    reach_ = std::max(reach_, classes_.back().reach.point);
  }
}

Level ShapedMagnets::level(std::size_t first, std::size_t second, double distance) const {
  const Reach& a = classes_[class_of_[first]].reach;
  const Reach& b = classes_[class_of_[second]].reach;
  if (distance >= std::max(a.point, b.point)) return Level::point;
  if (distance >= std::max(a.coarse, b.coarse)) return Level::coarse;
  if (distance >= std::max(a.mixed, b.mixed)) return Level::mixed;
  if (distance >= std::max(a.fine, b.fine)) return Level::fine;
  return Level::charges;
}

Eigen::Matrix3d ShapedMagnets::axes(std::size_t magnet, const Eigen::Matrix3d& rotation) const {
  if (is_turned_[magnet] == 0) return rotation;
  return rotation * turned_[magnet];
}

Interaction ShapedMagnets::between(const Pair& pair, const Points& first,
                                   const Points& second) const {
  const Vector3 moment = vector(pair.first_moment);
  Interaction sum;
  for (std::size_t k = 0; k < first.count; ++k) {
    if (first.weight[k] == 0) continue;
    const Vector3 lever = at(first, k);
    const PointResult result = pair.kernel.points(pair.first_moment, pair.second_moment,
                                                  row(pair.separation + lever), second);
    const Vector3 force = first.weight[k] * vector(result.force);
    sum.force_on_first += force;
    sum.torque_on_first +=
        first.weight[k] * moment.cross(vector(result.field)) + lever.cross(force);
  }
  sum.torque_on_second = -sum.torque_on_first - pair.separation.cross(sum.force_on_first);
  return sum;
}

Interaction ShapedMagnets::mixed(const Pair& pair, const Points& first,
                                 const Points& second) const {
  const PointResult one =
      pair.kernel.points(pair.first_moment, pair.second_moment, row(pair.separation), second);
  const PointResult two =
      pair.kernel.points(pair.second_moment, pair.first_moment, row(-pair.separation), first);
  const Vector3 force1 = vector(one.force);
  const Vector3 force2 = vector(two.force);
  const Vector3 torques = vector(pair.first_moment).cross(vector(one.field)) -
                          vector(pair.second_moment).cross(vector(two.field));
  return {force1 - force2, torques + pair.separation.cross(force2),
          -torques - pair.separation.cross(force1)};
}

PlacedShape ShapedMagnets::placed(const Dipoles& dipoles, std::size_t magnet,
                                  const Eigen::Matrix3d& axes) const {
  return {&classes_[class_of_[magnet]].shape, vector(dipoles.positions[magnet]), axes,
          vector(dipoles.moments[magnet])};
}

Interaction ShapedMagnets::beyond_dipoles(const Kernel& kernel, const Dipoles& dipoles,
                                          std::size_t first, std::size_t second,
                                          const Eigen::Matrix3d& first_rotation,
                                          const Eigen::Matrix3d& second_rotation,
                                          double minimum_distance) const {
  const Vector3 r = vector(dipoles.positions[first]) - vector(dipoles.positions[second]);
  const Level used = level(first, second, r.norm());
  if (used == Level::point) return {};
  const Pair pair{kernel, dipoles.moments[first], dipoles.moments[second], r};
  const ShapeClass& a = classes_[class_of_[first]];
  const ShapeClass& b = classes_[class_of_[second]];
  const Eigen::Matrix3d first_axes = axes(first, first_rotation);
  const Eigen::Matrix3d second_axes = axes(second, second_rotation);
  Interaction result;
  double dipoles_taken = 1;
  if (used == Level::coarse) {
    result = between(pair, whole(a.coarse, first_axes), whole(b.coarse, second_axes));
  } else if (used == Level::mixed) {
    // Fine against dipole both ways, less the dipoles that are now there twice. The centres of the
    // fine rules are a share of them.
    result = mixed(pair, shell(a.fine, first_axes), shell(b.fine, second_axes));
    dipoles_taken = 2 - a.fine.centre_weight - b.fine.centre_weight;
  } else if (used == Level::fine) {
    result = between(pair, whole(a.fine, first_axes), whole(b.fine, second_axes));
  } else {
    result = charge_pair(placed(dipoles, first, first_axes), placed(dipoles, second, second_axes),
                         share / 2 * tolerance_);
  }
  const Interaction dipole =
      dipole_pair(vector(pair.first_moment), vector(pair.second_moment), r, minimum_distance);
  result.force_on_first -= dipoles_taken * dipole.force_on_first;
  result.torque_on_first -= dipoles_taken * dipole.torque_on_first;
  result.torque_on_second -= dipoles_taken * dipole.torque_on_second;
  return result;
}

Vector3 ShapedMagnets::field(const Kernel& kernel, const Dipoles& dipoles, std::size_t magnet,
                             const Eigen::Matrix3d& rotation, const Vector3& point) const {
  const Vector3 r = point - vector(dipoles.positions[magnet]);
  const ShapeClass& kind = classes_[class_of_[magnet]];
  const Eigen::Matrix3d turn = axes(magnet, rotation);
  if (r.norm() >= kind.reach.fine) {
    return vector(kernel.points({}, dipoles.moments[magnet], row(r), whole(kind.fine, turn)).field);
  }
  const Vector3 moment = vector(dipoles.moments[magnet]);
  return turn * shape_field(kind.shape, turn.transpose() * moment, turn.transpose() * r,
                            1e-2 * tolerance_);
}

}  // namespace ziggurat::magnetism
