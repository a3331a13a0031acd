// SPDX-License-Identifier: MIT
// The convex hull of points, by Qhull.

#include <fmt/format.h>
#include <libqhull_r/qhull_ra.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "math/pose.h"
#include "scene/geometry.h"

namespace ziggurat::scene {
namespace {

using Eigen::Matrix3d;
using math::Vector3;

/// Tolerance of flat faces, relative to the hull's size.
constexpr double flat = 1e-9;

/// Twice the area of a polygon along its normal (M. Newell's sum).
Vector3 area_vector(const std::vector<Vector3>& vertices, const std::vector<std::size_t>& corners) {
  Vector3 sum = Vector3::Zero();
  const Vector3& first = vertices[corners[0]];
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    sum += (vertices[corners[i]] - first).cross(vertices[corners[i + 1]] - first);
  }
  return sum;
}

/// A run of Qhull: its facets, as indices of points.
class Run {
 public:
  explicit Run(std::span<const Vector3> points) : coordinates_(3 * points.size()) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (Eigen::Index k = 0; k < 3; ++k) {
        coordinates_[3 * i + static_cast<std::size_t>(k)] = points[i][k];
      }
    }
    complaints_.reset(std::fopen("/dev/null", "w"));
    qh_zero(&qh_, complaints_.get());
    char options[] = "qhull Pp";
    done_ =
        complaints_ && qh_new_qhull(&qh_, 3, static_cast<int>(points.size()), coordinates_.data(),
                                    False, options, nullptr, complaints_.get()) == 0;
  }
  ~Run() {
    qh_freeqhull(&qh_, !qh_ALL);
    int pieces = 0, bytes = 0;
    qh_memfreeshort(&qh_, &pieces, &bytes);
  }
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  bool done() const { return done_; }

  std::vector<std::vector<std::size_t>> facets() {
    std::vector<std::vector<std::size_t>> found;
    for (facetT* facet = qh_.facet_list; facet && facet->next; facet = facet->next) {
      setT* around = qh_facet3vertex(&qh_, facet);
      std::vector<std::size_t> corners;
      for (int i = 0; i < qh_setsize(&qh_, around); ++i) {
        const auto* vertex = static_cast<vertexT*>(around->e[i].p);
        corners.push_back(static_cast<std::size_t>(qh_pointid(&qh_, vertex->point)));
      }
      qh_settempfree(&qh_, &around);
      found.push_back(std::move(corners));
    }
    return found;
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::vector<double> coordinates_;
  std::unique_ptr<std::FILE, Close> complaints_;
  qhT qh_{};
  bool done_ = false;
};

/// Numbers the points that are corners, in the order of the points.
Polyhedron from_facets(std::span<const Vector3> points,
                       std::vector<std::vector<std::size_t>> facets) {
  Polyhedron hull;
  std::vector<std::size_t> number(points.size(), 0);
  for (const auto& facet : facets) {
    for (const std::size_t corner : facet) number[corner] = 1;
  }
  Vector3 middle = Vector3::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (number[i] == 0) continue;
    number[i] = hull.vertices.size();
    hull.vertices.push_back(points[i]);
    middle += points[i];
  }
  middle /= static_cast<double>(hull.vertices.size());
  for (auto& facet : facets) {
    for (std::size_t& corner : facet) corner = number[corner];
    Vector3 normal = area_vector(hull.vertices, facet);
    if (normal.dot(hull.vertices[facet[0]] - middle) < 0) {
      std::ranges::reverse(facet);
      normal = -normal;
    }
    normal.normalize();
    double offset = normal.dot(hull.vertices[facet[0]]);
    for (const std::size_t i : facet) offset = std::max(offset, normal.dot(hull.vertices[i]));
    hull.faces.push_back({normal, offset, std::move(facet)});
  }
  return hull;
}

/// Sums of the tetrahedra between a point and the triangles of all faces: that of a tetrahedron
/// with corners 0, a, b, c is det(a, b, c) / 120 * (sum of v v^T + s s^T), s the sum of all v.
/// @returns the volume [m^3]
double add_mass_properties(Polyhedron& hull) {
  const Vector3 origin = hull.vertices[0];
  double volume = 0;
  Vector3 moment = Vector3::Zero();
  Matrix3d second = Matrix3d::Zero();
  for (const Polyhedron::Face& face : hull.faces) {
    const Vector3 a = hull.vertices[face.corners[0]] - origin;
    for (std::size_t i = 1; i + 1 < face.corners.size(); ++i) {
      const Vector3 b = hull.vertices[face.corners[i]] - origin;
      const Vector3 c = hull.vertices[face.corners[i + 1]] - origin;
      const double det = a.dot(b.cross(c));
      const Vector3 sum = a + b + c;
      volume += det / 6;
      moment += det / 24 * sum;
      second += det / 120 *
                (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
    }
  }
  if (!(volume > 0)) return 0;
  const Vector3 center = moment / volume;
  const Matrix3d about_center = second / volume - center * center.transpose();
  const Matrix3d inertia = about_center.trace() * Matrix3d::Identity() - about_center;
  hull.center_of_mass = origin + center;
  hull.axes = math::principal_axes(inertia);
  const Matrix3d axes = hull.axes.toRotationMatrix();
  hull.inertia = (axes.transpose() * inertia * axes).diagonal();
  return volume;
}

constexpr const char* no_volume =
    "has no volume; write at least 4 vertices that are not all in one plane";

}  // namespace

std::variant<Hull, std::string> make_hull(std::span<const Vector3> points) {
  if (points.size() < 4) return no_volume;
  Run run(points);
  if (!run.done()) return no_volume;
  Polyhedron hull = from_facets(points, run.facets());
  if (hull.vertices.size() > Hull::most_vertices) {
    return fmt::format(
        "has {} corners; at most {} are allowed, so leave out those that matter "
        "least",
        hull.vertices.size(), Hull::most_vertices);
  }
  const double volume = add_mass_properties(hull);
  Vector3 low = hull.vertices[0], high = low;
  for (const Vector3& vertex : hull.vertices) {
    low = low.cwiseMin(vertex);
    high = high.cwiseMax(vertex);
  }
  if (!(volume > flat * std::pow((high - low).norm(), 3))) return no_volume;
  return Hull{std::make_shared<const Polyhedron>(std::move(hull))};
}

}  // namespace ziggurat::scene
