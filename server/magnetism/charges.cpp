// SPDX-License-Identifier: MIT
#include "magnetism/charges.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "magnetism/elementary.h"
#include "magnetism/exact_field.h"

namespace ziggurat::magnetism {
namespace {

constexpr int most_panel_nodes = 6;
constexpr int deepest = 40;  // halvings of a patch, both directions together
/// Smallest resolved gap of a cylinder's field, as a share of its longest side; smaller gaps count
/// as this one. It bounds the cost of magnets that touch or overlap.
constexpr double closest_share = 0.03;
/// The same for a box, as distances from its edges, where they are along a side of the patch. Where
/// they are oblique, patches must be small in both directions, and the second counts.
constexpr double closest_aligned_share = 1e-4;
constexpr double closest_oblique_share = 0.01;
/// A patch's quadrature error falls as rho^-2k for k nodes; what is asked of it, as a multiple of
/// the tolerance. Only the strip next to an edge of the source comes near the bound, so that the
/// whole is far better (docs/magnetism.md).
constexpr double patch_share = 0.3;

struct GaussRule {
  double node[most_panel_nodes];
  double weight[most_panel_nodes];
};

constexpr GaussRule gauss[] = {
    {{0}, {2}},
    {{-0.5773502691896257, 0.5773502691896257}, {1, 1}},
    {{-0.7745966692414834, 0, 0.7745966692414834},
     {0.5555555555555556, 0.8888888888888888, 0.5555555555555556}},
    {{-0.8611363115940526, -0.3399810435848563, 0.3399810435848563, 0.8611363115940526},
     {0.3478548451374538, 0.6521451548625461, 0.6521451548625461, 0.3478548451374538}},
    {{-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831, 0.9061798459386640},
     {0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
      0.2369268850561891}},
    {{-0.9324695142031521, -0.6612093864662645, -0.2386191860831969, 0.2386191860831969,
      0.6612093864662645, 0.9324695142031521},
     {0.1713244923791704, 0.3607615730481386, 0.4679139345726910, 0.4679139345726910,
      0.3607615730481386, 0.1713244923791704}}};

/// Sine and cosine of an angle in [-pi, pi], the same on every machine: series of a sixteenth.
Eigen::Vector2d unit_at(double turn) {
  const double x = turn / 16;
  const double square = x * x;
  double s = x * (1 - square / 6 * (1 - square / 20 * (1 - square / 42 * (1 - square / 72))));
  double c = 1 - square / 2 * (1 - square / 12 * (1 - square / 30 * (1 - square / 56)));
  for (int k = 0; k < 4; ++k) {
    const double doubled = 2 * s * c;
    c = c * c - s * s;
    s = doubled;
  }
  return {c, s};
}

/// One charge of a surface: where, and how much per area of the patch's two parameters.
struct Charge {
  Vector3 position;  // in the carrier's frame [m]
  double density;    // [A m per unit of both parameters]
};

/// An edge of a charged face: the field next to it is not smooth.
struct Edge {
  Vector3 start;    // [m]
  Vector3 tangent;  // unit vector
  double length;    // [m]
};

/// Edges along which faces of the box with charges end, in its frame.
std::vector<Edge> charged_edges(const Box& box, const Vector3& moment) {
  std::vector<Edge> edges;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    if (moment[u] == 0 && moment[v] == 0) continue;
    for (const double i : {-0.5, 0.5}) {
      for (const double j : {-0.5, 0.5}) {
        Vector3 start = -box.size / 2;
        start[u] = i * box.size[u];
        start[v] = j * box.size[v];
        edges.push_back({start, Vector3::Unit(axis), box.size[axis]});
      }
    }
  }
  return edges;
}

/// The charged shape as seen from the source: everything in the source's frame.
struct Integration {
  const Shape* source;
  Vector3 source_moment;
  Eigen::Matrix3d rotation;  // from the carrier's axes to the source's
  Vector3 offset;            // of the carrier's centre [m]
  double tolerance;
  std::vector<Edge> edges;           // of a box
  double width = 0;                  // of a box: geometric mean of its two longest sides [m]
  Vector3 force = Vector3::Zero();   // on the carrier
  Vector3 torque = Vector3::Zero();  // about the carrier's centre

  Vector3 place(const Charge& charge) const { return offset + rotation * charge.position; }

  /// A charge inside the source, where magnets overlap, counts as one on its nearest face: the
  /// field jumps there, and the force is to have no jump where magnets touch.
  void add(const Charge& charge, double weight) {
    const Vector3 lever = rotation * charge.position;
    const Vector3 field =
        shape_field(*source, source_moment, outside(*source, offset + lever), 1e-2 * tolerance);
    const Vector3 push = (charge.density * weight) * field;
    force += push;
    torque += lever.cross(push);
  }
};

/// A rectangle of two parameters.
struct Patch {
  double u, v;            // middle
  double half_u, half_v;  // half widths
};

/// Half widths of a patch over its distance from where the source's field is not smooth.
struct Closeness {
  double u = 0, v = 0;

  void widen(double to_u, double to_v) {
    u = std::max(u, to_u);
    v = std::max(v, to_v);
  }
};

/// @param half_u, half_v  at the point, half the patch's extent along each parameter [m]
void approach(const Integration& integration, const Vector3& point, const Vector3& half_u,
              const Vector3& half_v, Closeness& closeness) {
  const double length_u = half_u.norm();
  const double length_v = half_v.norm();
  if (integration.edges.empty()) {
    const double distance = std::max(distance_outside(*integration.source, point),
                                     closest_share * longest_side(*integration.source));
    closeness.widen(length_u / distance, length_v / distance);
  }
  for (const Edge& edge : integration.edges) {
    const Vector3 from_start = point - edge.start;
    const double along = std::clamp(from_start.dot(edge.tangent), 0.0, edge.length);
    const double distance = (from_start - along * edge.tangent).norm();
    // Along an edge the field changes only with the distance from its ends.
    const double across_u = (half_u - half_u.dot(edge.tangent) * edge.tangent).norm();
    const double across_v = (half_v - half_v.dot(edge.tangent) * edge.tangent).norm();
    const double oblique = across_u * across_v / (length_u * length_v);
    const double closest =
        integration.width * std::max(closest_aligned_share, closest_oblique_share * oblique);
    closeness.widen(across_u / std::max(distance, closest), across_v / std::max(distance, closest));
    const double end =
        std::max(std::min(from_start.norm(), (from_start - edge.length * edge.tangent).norm()),
                 closest_oblique_share * integration.width);
    closeness.widen(length_u / end, length_v / end);
  }
}

/// Nodes for a half width over a distance; more than most_panel_nodes: divide.
int nodes_for(double closeness, double goal) {
  const double ratio = 1 / std::max(closeness, 1e-9);
  const double rho = ratio + std::sqrt(1 + ratio * ratio);
  const double needed = goal / (2 * logarithm(rho) + 1e-9);
  const int least = goal > 4 ? 3 : 2;
  return needed > most_panel_nodes ? most_panel_nodes + 1
                                   : std::max(least, static_cast<int>(std::ceil(needed)));
}

/// @param surface  Charge(u, v)
template <class Surface>
Closeness closeness_of(const Integration& integration, const Surface& surface, const Patch& patch) {
  Vector3 points[3][3];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      points[i][j] = integration.place(
          surface(patch.u + (i - 1) * patch.half_u, patch.v + (j - 1) * patch.half_v));
    }
  }
  Closeness closeness;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      approach(integration, points[i][j], (points[2][j] - points[0][j]) / 2,
               (points[i][2] - points[i][0]) / 2, closeness);
    }
  }
  return closeness;
}

template <class Surface>
void integrate(Integration& integration, const Surface& surface, const Patch& patch, int depth) {
  const Closeness closeness = closeness_of(integration, surface, patch);
  const double goal = -logarithm(patch_share * integration.tolerance);
  const int nodes_u = nodes_for(closeness.u, goal);
  const int nodes_v = nodes_for(closeness.v, goal);
  if (std::max(nodes_u, nodes_v) > most_panel_nodes && depth < deepest) {
    Patch half = patch;
    const bool along_u = closeness.u >= closeness.v;
    (along_u ? half.half_u : half.half_v) /= 2;
    for (const double side : {-1.0, 1.0}) {
      half.u = patch.u + (along_u ? side * half.half_u : 0);
      half.v = patch.v + (along_u ? 0 : side * half.half_v);
      integrate(integration, surface, half, depth + 1);
    }
    return;
  }
  const GaussRule& rule_u = gauss[std::min(nodes_u, most_panel_nodes) - 1];
  const GaussRule& rule_v = gauss[std::min(nodes_v, most_panel_nodes) - 1];
  for (int i = 0; i < std::min(nodes_u, most_panel_nodes); ++i) {
    for (int j = 0; j < std::min(nodes_v, most_panel_nodes); ++j) {
      integration.add(
          surface(patch.u + patch.half_u * rule_u.node[i], patch.v + patch.half_v * rule_v.node[j]),
          patch.half_u * patch.half_v * rule_u.weight[i] * rule_v.weight[j]);
    }
  }
}

void integrate_box(Integration& integration, const Vector3& half, const Vector3& magnetisation) {
  for (int axis = 0; axis < 3; ++axis) {
    if (magnetisation[axis] == 0) continue;
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (const double side : {-1.0, 1.0}) {
      const auto face = [&](double a, double b) {
        Vector3 position;
        position[axis] = side * half[axis];
        position[u] = a;
        position[v] = b;
        return Charge{position, side * magnetisation[axis]};
      };
      integrate(integration, face, {0, 0, half[u], half[v]}, 0);
    }
  }
}

void integrate_cylinder(Integration& integration, const Cylinder& cylinder,
                        const Vector3& magnetisation) {
  const double radius = cylinder.radius;
  const double half = cylinder.height / 2;
  constexpr int sectors = 6;
  for (int k = 0; k < sectors; ++k) {
    const double turn = -pi + (2 * k + 1) * pi / sectors;
    if (magnetisation.z() != 0) {
      for (const double side : {-1.0, 1.0}) {
        const auto cap = [&](double r, double angle) {
          const auto unit = unit_at(angle);
          return Charge{{r * unit.x(), r * unit.y(), side * half}, side * magnetisation.z() * r};
        };
        integrate(integration, cap, {radius / 2, turn, radius / 2, pi / sectors}, 0);
      }
    }
    if (magnetisation.x() != 0 || magnetisation.y() != 0) {
      const auto side = [&](double z, double angle) {
        const auto unit = unit_at(angle);
        const double normal = magnetisation.x() * unit.x() + magnetisation.y() * unit.y();
        return Charge{{radius * unit.x(), radius * unit.y(), z}, normal * radius};
      };
      integrate(integration, side, {0, turn, half, pi / sectors}, 0);
    }
  }
}

/// A dipole is two opposite charges close together: the field's difference between them.
void integrate_point(Integration& integration, const Vector3& moment) {
  const double magnitude = moment.norm();
  if (!(magnitude > 0)) return;
  const double reach =
      1e-4 * std::max({distance_outside(*integration.source, integration.offset),
                       1e-3 * integration.offset.norm(), 1e-3 * longest_side(*integration.source)});
  const Vector3 lever = moment * (reach / magnitude);
  for (const double side : {-1.0, 1.0}) {
    integration.add({side * lever, side * magnitude / (2 * reach)}, 1);
  }
}

/// Components below this share of the magnetisation are rounding, not magnetisation.
Vector3 cleaned(const Vector3& moment) {
  return (moment.cwiseAbs().array() > 1e-12 * moment.norm()).select(moment, 0.0);
}

bool is_point(const Shape& shape) {
  return std::holds_alternative<PointShape>(shape) || std::holds_alternative<Sphere>(shape);
}

double flatness(const Vector3& size) { return size.minCoeff() / size.maxCoeff(); }

/// The opposite faces of flat magnets nearly cancel: the error of each must be smaller by this. A
/// cylinder's field is too expensive for that, and its error stays within the tolerance without.
double cancellation(const Shape& source, const Shape& carrier) {
  const auto* box = std::get_if<Box>(&source);
  if (box == nullptr) return 1;
  if (const auto* other = std::get_if<Box>(&carrier))
    return flatness(box->size) * flatness(other->size);
  if (const auto* other = std::get_if<Cylinder>(&carrier)) {
    const double width = 2 * other->radius;
    return flatness(box->size) * flatness({width, width, other->height});
  }
  return flatness(box->size);
}

/// Boxes have the cheapest exact field, points have none.
bool better_source(const Shape& a, const Shape& b) {
  if (is_point(a) || is_point(b)) return is_point(b);
  return std::holds_alternative<Box>(a) || !std::holds_alternative<Box>(b);
}

/// @returns force on the carrier and torque about its centre, in the world
Wrench push(const PlacedShape& source, const PlacedShape& carrier, double tolerance) {
  const Eigen::Matrix3d to_source = source.rotation.transpose();
  Integration integration{source.shape,
                          cleaned(to_source * source.moment),
                          to_source * carrier.rotation,
                          to_source * (carrier.position - source.position),
                          tolerance * cancellation(*source.shape, *carrier.shape),
                          {},
                          0};
  if (const auto* box = std::get_if<Box>(source.shape)) {
    integration.edges = charged_edges(*box, integration.source_moment);
    integration.width = std::sqrt(box->size.prod() / box->size.minCoeff());
  }
  const Vector3 moment = cleaned(carrier.rotation.transpose() * carrier.moment);
  if (const auto* box = std::get_if<Box>(carrier.shape)) {
    integrate_box(integration, box->size / 2, moment / volume(*carrier.shape));
  } else if (const auto* cylinder = std::get_if<Cylinder>(carrier.shape)) {
    integrate_cylinder(integration, *cylinder, moment / volume(*carrier.shape));
  } else {
    integrate_point(integration, moment);
  }
  return {source.rotation * integration.force, source.rotation * integration.torque};
}

}  // namespace

Interaction charge_pair(const PlacedShape& first, const PlacedShape& second, double tolerance) {
  const bool swap = !better_source(*first.shape, *second.shape);
  const PlacedShape& source = swap ? second : first;
  const PlacedShape& carrier = swap ? first : second;
  const Wrench wrench = push(source, carrier, tolerance);
  const Vector3 reaction =
      -wrench.torque - (carrier.position - source.position).cross(wrench.force);
  if (swap) return {wrench.force, wrench.torque, reaction};
  return {-wrench.force, reaction, wrench.torque};
}

}  // namespace ziggurat::magnetism
