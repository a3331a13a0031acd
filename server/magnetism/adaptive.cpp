#include "magnetism/adaptive.h"

#include <algorithm>

#include "magnetism/exact_field.h"

namespace ziggurat::magnetism {
namespace {

Vector3 vector(const Row& row) { return {row.x, row.y, row.z}; }
Row row(const Vector3& v) { return {v.x(), v.y(), v.z(), 0}; }

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

/// Of the points, then of the centre.
std::vector<double> padded_weights(const Rule& rule) {
  std::vector<double> weights = rule.weights;
  weights.resize(padded(weights.size()), 0);  // so that the centre may be left out
  weights.push_back(rule.centre_weight);
  weights.resize(padded(weights.size()), 0);
  return weights;
}

/// Without the centre.
Points shell(Points points, const Rule& rule) {
  points.count = padded(rule.points.size());
  return points;
}

Vector3 at(const Points& points, std::size_t k) { return {points.x[k], points.y[k], points.z[k]}; }

}  // namespace

ShapedMagnets::ShapedMagnets(const std::vector<Shape>& shapes,
                             const std::vector<math::Quaternion>& orientations, double tolerance)
    : tolerance_(tolerance), coarse_(shapes.size()), fine_(shapes.size()) {
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    auto found = std::find_if(classes_.begin(), classes_.end(), [&](const ShapeClass& known) {
      return same_shape(known.shape, shapes[i]);
    });
    class_of_.push_back(static_cast<std::uint32_t>(found - classes_.begin()));
    turned_.push_back(orientations[i].toRotationMatrix());
    if (found != classes_.end()) continue;
    const Rule coarse = coarse_rule(shapes[i]);
    const Rule fine = fine_rule(shapes[i]);
    classes_.push_back({shapes[i], coarse, fine, padded_weights(coarse), padded_weights(fine),
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

Points ShapedMagnets::cloud(std::size_t magnet, const Eigen::Matrix3d& rotation, bool fine) {
  const ShapeClass& kind = classes_[class_of_[magnet]];
  const Rule& rule = fine ? kind.fine : kind.coarse;
  const std::vector<double>& weights = fine ? kind.fine_weights : kind.coarse_weights;
  Placed& placed = fine ? fine_[magnet] : coarse_[magnet];
  if (placed.substep != substep_) {
    placed.substep = substep_;
    placed.x.resize(weights.size(), 0);
    placed.y.resize(weights.size(), 0);
    placed.z.resize(weights.size(), 0);
    const Eigen::Matrix3d whole = rotation * turned_[magnet];
    for (std::size_t k = 0; k < rule.points.size(); ++k) {
      const Vector3 point = whole * rule.points[k];
      placed.x[k] = point.x();
      placed.y[k] = point.y();
      placed.z[k] = point.z();
    }
  }
  return {placed.x.data(), placed.y.data(), placed.z.data(), weights.data(), weights.size()};
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

PlacedShape ShapedMagnets::placed(const Dipoles& dipoles, std::size_t magnet, const Shape& shape,
                                  const Eigen::Matrix3d& rotation) const {
  return {&shape, vector(dipoles.positions[magnet]), rotation * turned_[magnet],
          vector(dipoles.moments[magnet])};
}

Interaction ShapedMagnets::beyond_dipoles(const Kernel& kernel, const Dipoles& dipoles,
                                          std::size_t first, std::size_t second,
                                          const Eigen::Matrix3d& first_rotation,
                                          const Eigen::Matrix3d& second_rotation,
                                          double minimum_distance) {
  const Vector3 r = vector(dipoles.positions[first]) - vector(dipoles.positions[second]);
  const Pair pair{kernel, dipoles.moments[first], dipoles.moments[second], r};
  const auto a = [&](bool fine) { return cloud(first, first_rotation, fine); };
  const auto b = [&](bool fine) { return cloud(second, second_rotation, fine); };
  const ShapeClass& first_class = classes_[class_of_[first]];
  const ShapeClass& second_class = classes_[class_of_[second]];
  Interaction result;
  double dipoles_taken = 1;
  switch (level(first, second, r.norm())) {
    case Level::point:
      return result;
    case Level::coarse:
      result = between(pair, a(false), b(false));
      break;
    case Level::mixed:
      // Fine against dipole both ways, less the dipoles that are now there twice. The centres of
      // the fine rules are a share of them.
      result = mixed(pair, shell(a(true), first_class.fine), shell(b(true), second_class.fine));
      dipoles_taken = 2 - first_class.fine.centre_weight - second_class.fine.centre_weight;
      break;
    case Level::fine:
      result = between(pair, a(true), b(true));
      break;
    case Level::charges:
      result = charge_pair(placed(dipoles, first, first_class.shape, first_rotation),
                           placed(dipoles, second, second_class.shape, second_rotation),
                           share / 2 * tolerance_);
      break;
  }
  const Interaction dipole =
      dipole_pair(vector(pair.first_moment), vector(pair.second_moment), r, minimum_distance);
  result.force_on_first -= dipoles_taken * dipole.force_on_first;
  result.torque_on_first -= dipoles_taken * dipole.torque_on_first;
  result.torque_on_second -= dipoles_taken * dipole.torque_on_second;
  return result;
}

Vector3 ShapedMagnets::field(const Kernel& kernel, const Dipoles& dipoles, std::size_t magnet,
                             const Eigen::Matrix3d& rotation, const Vector3& point) {
  const Vector3 r = point - vector(dipoles.positions[magnet]);
  const ShapeClass& kind = classes_[class_of_[magnet]];
  const Vector3 moment = vector(dipoles.moments[magnet]);
  if (r.norm() >= kind.reach.fine) {
    const Points fine = cloud(magnet, rotation, true);
    return vector(kernel.points({}, dipoles.moments[magnet], row(r), fine).field);
  }
  const Eigen::Matrix3d axes = rotation * turned_[magnet];
  return axes * shape_field(kind.shape, axes.transpose() * moment, axes.transpose() * r,
                            1e-2 * tolerance_);
}

}  // namespace ziggurat::magnetism
