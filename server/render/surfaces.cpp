// SPDX-License-Identifier: MIT
#include "render/surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace ziggurat::render {
namespace {

using math::Vector2;
using math::Vector3;

constexpr double near_plane = 1e-3;     // [m]
constexpr double before_body = 1.0003;  // depth of marks and lines: before what they lie on

Vector3 to_vector(const Float3& point) { return {point[0], point[1], point[2]}; }

/// A convex figure of the picture, before its edges are known.
struct Outline {
  std::array<Vector2, 6> corners;  // [px]
  unsigned count = 0;
};

Vector2 project(const Lens& lens, const Vector3& point) {
  return {lens.center_x + lens.focal_x * point.x() / point.z(),
          lens.center_y + lens.focal_y * point.y() / point.z()};
}

/// The part of a convex figure behind the near plane.
Outline outline_of(const Lens& lens, std::span<const Vector3> corners) {
  Outline outline;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector3 &a = corners[i], &b = corners[i + 1 == corners.size() ? 0 : i + 1];
    const bool a_shows = a.z() >= near_plane, b_shows = b.z() >= near_plane;
    if (a_shows) outline.corners[outline.count++] = project(lens, a);
    if (a_shows == b_shows) continue;
    // From the same end, whichever face has the edge.
    const Vector3 &seen = a_shows ? a : b, &hidden = a_shows ? b : a;
    const Vector3 cut =
        seen + (hidden - seen) * ((near_plane - seen.z()) / (hidden.z() - seen.z()));
    outline.corners[outline.count++] = project(lens, cut);
  }
  return outline;
}

/// @returns false if it has no part in the picture
bool set_edges(const Outline& outline, const Lens& lens, Polygon& polygon) {
  if (outline.count < 3) return false;
  Vector2 low = outline.corners[0], high = low;
  for (unsigned i = 1; i < outline.count; ++i) {
    low = low.cwiseMin(outline.corners[i]);
    high = high.cwiseMax(outline.corners[i]);
  }
  if (!(low.x() < lens.width && low.y() < lens.height && high.x() > 0 && high.y() > 0))
    return false;
  polygon.top = low.y();
  polygon.bottom = high.y();
  polygon.count = 0;
  for (unsigned i = 0; i < outline.count; ++i) {
    const Vector2 &a = outline.corners[i], &b = outline.corners[(i + 1) % outline.count];
    if (a.y() == b.y()) continue;
    const Vector2 &upper = a.y() < b.y() ? a : b, &lower = a.y() < b.y() ? b : a;
    polygon.edges[polygon.count++] = {upper.x(), upper.y(), lower.y(),
                                      (lower.x() - upper.x()) / (lower.y() - upper.y())};
  }
  return true;
}

/// Coordinates on a body, as its link's frame has them in units of its mesh.
std::array<std::array<float, 4>, 3> own_coordinates(const BodyInstance& body) {
  std::array<std::array<float, 4>, 3> rows{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3 axis = to_vector(body.axes[i]);
    const Vector3 row = axis / axis.squaredNorm();
    const double offset = -row.dot(to_vector(body.position));
    rows[i] = {static_cast<float>(row.x()), static_cast<float>(row.y()),
               static_cast<float>(row.z()), static_cast<float>(offset)};
  }
  return rows;
}

void scale(std::array<float, 4>& row, float factor, float shift) {
  for (float& value : row) value *= factor;
  row[3] += shift;
}

/// 1 on the side p q of a triangle, 0 at its corner m.
std::array<float, 4> from_middle(const Vector3& m, const Vector3& p, const Vector3& q) {
  const Vector3 side = q - p;
  const double square = side.squaredNorm();
  const Vector3 height =
      square > 0 ? Vector3((p - m) - side * ((p - m).dot(side) / square)) : p - m;
  const Vector3 row = height / std::max(height.squaredNorm(), 1e-300);
  return {static_cast<float>(row.x()), static_cast<float>(row.y()), static_cast<float>(row.z()),
          static_cast<float>(-row.dot(m))};
}

/// One body on its way into the scenery.
class BodyFaces {
 public:
  BodyFaces(const BodyInstance& body, const Meshes& meshes, const Mesh& mesh, const Lens& lens,
            Scenery& scenery)
      : body_(body), meshes_(meshes), mesh_(mesh), lens_(lens), scenery_(scenery) {
    known_.fill(0);
  }

  /// @param i  of the mesh's triangles
  void add(std::uint32_t i) {
    const std::uint32_t* index = &meshes_.indices[mesh_.first_index + std::size_t{3} * i];
    const std::array<Vector3, 3> corners{scenery_.corners[index[0]], scenery_.corners[index[1]],
                                         scenery_.corners[index[2]]};
    const Vector3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    const double offset = normal.dot(corners[0]);
    if (!(offset < 0)) return;  // its back
    Polygon polygon;
    if (!set_edges(outline_of(lens_, corners), lens_, polygon)) return;
    polygon.depth = depth_of_plane(lens_, normal, offset);
    const Vertex& first = meshes_.vertices[mesh_.first_vertex + index[0]];
    const bool is_round = mesh_.kind == Mesh::Kind::sphere ||
                          (mesh_.kind == Mesh::Kind::cylinder && first.normal[2] == 0);
    // Triangles of one face share a surface: the sides of a box, a cylinder's mantle and ends.
    std::uint32_t own = 0;
    std::uint32_t& number = mesh_.kind == Mesh::Kind::hull  ? own
                            : mesh_.kind == Mesh::Kind::box ? known_[i / 2]
                            : is_round                      ? known_[0]
                            : first.normal[2] < 0           ? known_[1]
                                                            : known_[2];
    if (number == 0) {
      number = first_surface_number + static_cast<std::uint32_t>(scenery_.surfaces.size());
      scenery_.surfaces.push_back(is_round ? round_surface() : flat_surface(first));
      scenery_.surfaces.back().depth = polygon.depth;
      if (mesh_.kind == Mesh::Kind::hull) {
        scenery_.surfaces.back().coordinates[0] = from_middle(corners[0], corners[1], corners[2]);
      }
    }
    polygon.surface = number;
    scenery_.polygons.push_back(polygon);
  }

 private:
  Surface surface() const {
    Surface result;
    result.half_size = {body_.size[0] / 2, body_.size[1] / 2, body_.size[2] / 2};
    result.smallest = std::min({body_.size[0], body_.size[1], body_.size[2]});
    result.color = body_.color;
    for (auto& row : result.coordinates) row = {0, 0, 0, no_edge};
    return result;
  }

  Surface flat_surface(const Vertex& vertex) const {
    Surface result = surface();
    result.kind = Surface::Kind::flat;
    Vector3 normal = Vector3::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      normal += to_vector(body_.axes[i]).normalized() * vertex.normal[i];
    }
    result.normal = to_floats(normal);
    if (mesh_.kind == Mesh::Kind::hull) return result;
    auto rows = own_coordinates(body_);
    if (mesh_.kind == Mesh::Kind::cylinder) {
      result.has_rim = true;
      result.coordinates[0] = rows[0];
      result.coordinates[1] = rows[1];
      return result;
    }
    scale(rows[0], 2, 0);
    scale(rows[1], 2, 0);
    scale(rows[2], 2, -1);
    for (std::size_t i = 0; i < 3; ++i) {
      if (vertex.normal[i] == 0) result.coordinates[i] = rows[i];
    }
    return result;
  }

  Surface round_surface() const {
    Surface result = surface();
    result.kind = Surface::Kind::round;
    const Vector3 base = to_vector(body_.position), up = to_vector(body_.axes[2]);
    result.radius = static_cast<float>(to_vector(body_.axes[0]).norm());
    if (mesh_.kind == Mesh::Kind::sphere) {
      result.center = to_floats(Vector3(base + up));
      return result;
    }
    const Vector3 axis = up.normalized();
    result.axis = to_floats(axis);
    result.center = to_floats(Vector3(base - axis * axis.dot(base)));
    result.coordinates[2] = own_coordinates(body_)[2];
    scale(result.coordinates[2], 2, -1);
    return result;
  }

  const BodyInstance& body_;
  const Meshes& meshes_;
  const Mesh& mesh_;
  const Lens& lens_;
  Scenery& scenery_;
  std::array<std::uint32_t, 6> known_;  // numbers of surfaces; 0: not made yet
};

void place_corners(const BodyInstance& body, const Meshes& meshes, const Mesh& mesh,
                   std::vector<Vector3>& corners) {
  const Vector3 x = to_vector(body.axes[0]), y = to_vector(body.axes[1]),
                z = to_vector(body.axes[2]), origin = to_vector(body.position);
  corners.resize(mesh.vertices);
  for (std::uint32_t i = 0; i < mesh.vertices; ++i) {
    const auto& at = meshes.vertices[mesh.first_vertex + i].position;
    corners[i] = origin + x * at[0] + y * at[1] + z * at[2];
  }
}

void throw_shadow(const Drawing& drawing, const Meshes& meshes, const Mesh& mesh,
                  ShadowMap& shadows, Scenery& scenery) {
  const Matrix4& m = drawing.light_from_camera;
  scenery.lit.resize(mesh.vertices);
  for (std::uint32_t i = 0; i < mesh.vertices; ++i) {
    const Vector3& p = scenery.corners[i];
    const auto row = [&](std::size_t j) {
      return m[j] * p.x() + m[j + 4] * p.y() + m[j + 8] * p.z() + m[j + 12];
    };
    scenery.lit[i] = {row(0) * shadow_size, row(1) * shadow_size, row(2)};
  }
  const std::uint32_t* index = &meshes.indices[mesh.first_index];
  for (std::uint32_t i = 0; i < mesh.indices; i += 3) {
    shadows.draw({scenery.lit[index[i]], scenery.lit[index[i + 1]], scenery.lit[index[i + 2]]});
  }
}

void add_body(const BodyInstance& body, const Meshes& meshes, const Mesh& mesh, const Lens& lens,
              Scenery& scenery) {
  BodyFaces faces(body, meshes, mesh, lens, scenery);
  for (std::uint32_t i = 0; i < mesh.indices / 3; ++i) faces.add(i);
}

/// A flat square with its coordinates. @returns false if it shows its back or is out of the picture
bool set_square(const MarkInstance& mark, const Lens& lens, Polygon& polygon, Surface& surface) {
  const Vector3 center = to_vector(mark.center), x = to_vector(mark.x), y = to_vector(mark.y);
  const Vector3 normal = x.cross(y);
  const double offset = normal.dot(center);
  if (!(offset < 0)) return false;
  const std::array<Vector3, 4> corners{center - x - y, center + x - y, center + x + y,
                                       center - x + y};
  if (!set_edges(outline_of(lens, corners), lens, polygon)) return false;
  surface.depth = depth_of_plane(lens, normal, offset);
  polygon.depth = {surface.depth.a * before_body, surface.depth.b * before_body,
                   surface.depth.c * before_body};
  surface.normal = to_floats(Vector3(normal.normalized()));
  for (const auto& [i, side] : {std::pair{0, x}, std::pair{1, y}}) {
    const Vector3 row = side / side.squaredNorm();
    surface.coordinates[static_cast<std::size_t>(i)] = {
        static_cast<float>(row.x()), static_cast<float>(row.y()), static_cast<float>(row.z()),
        static_cast<float>(-row.dot(center))};
  }
  return true;
}

/// A margin of one module, then a black border, then the pattern.
std::array<std::uint16_t, 12> white_modules(const MarkInstance& mark) {
  constexpr unsigned all = 0xfff, margin = 0xc03;  // margins of both sides
  std::array<std::uint16_t, 12> rows{all, all, margin, 0, 0, 0, 0, 0, 0, margin, all, all};
  for (unsigned row = 0; row < 6; ++row) {
    unsigned bits = margin;
    for (unsigned column = 0; column < 6; ++column) {
      const unsigned bit = 35 - (row * 6 + column);
      const std::uint32_t word = bit < 32 ? mark.code[1] >> bit : mark.code[2] >> (bit - 32);
      bits |= (word & 1u) << (column + 3);
    }
    rows[row + 3] = static_cast<std::uint16_t>(bits);
  }
  return rows;
}

void add_mark(const MarkInstance& mark, const Lens& lens, Scenery& scenery) {
  Polygon polygon;
  Surface surface;
  if (!set_square(mark, lens, polygon, surface)) return;
  const bool has_pattern = mark.code[0] == MarkInstance::pattern;
  surface.kind = has_pattern ? Surface::Kind::tag : Surface::Kind::plain;
  if (has_pattern) surface.white_modules = white_modules(mark);
  surface.color.fill(white_of_tags);
  polygon.surface = first_surface_number + static_cast<std::uint32_t>(scenery.surfaces.size());
  scenery.surfaces.push_back(surface);
  scenery.polygons.push_back(polygon);
}

/// A strip of constant width in the picture.
void add_line(const LineInstance& line, const Lens& lens, Scenery& scenery) {
  const Vector3 start = to_vector(line.start), end = to_vector(line.end);
  const Vector2 from = project(lens, start), to = project(lens, end);
  const double length = (to - from).norm();
  const Vector2 along = length > 0 ? Vector2((to - from) / length) : Vector2::UnitX();
  const Vector2 side = Vector2(-along.y(), along.x()) * (lens.line_width / 2);
  Outline outline;
  for (const Vector2& corner :
       {Vector2(from - side), Vector2(to - side), Vector2(to + side), Vector2(from + side)}) {
    outline.corners[outline.count++] = corner;
  }
  Polygon polygon;
  if (!set_edges(outline, lens, polygon)) return;
  const double near = before_body / start.z(), far = before_body / end.z();
  const Vector2 slope = length > 0 ? Vector2(along * ((far - near) / length)) : Vector2::Zero();
  polygon.depth = {slope.x(), slope.y(), near - slope.dot(from)};
  polygon.surface = first_surface_number + static_cast<std::uint32_t>(scenery.surfaces.size());
  Surface surface;
  surface.color = line.color;
  scenery.surfaces.push_back(surface);
  scenery.polygons.push_back(polygon);
}

}  // namespace

DepthPlane depth_of_plane(const Lens& lens, const Vector3& normal, double offset) {
  const double a = normal.x() / (lens.focal_x * offset), b = normal.y() / (lens.focal_y * offset);
  return {a, b, normal.z() / offset - a * lens.center_x - b * lens.center_y};
}

void add_surfaces(const Drawing& drawing, const Meshes& meshes, const Lens& lens,
                  ShadowMap& shadows, Scenery& scenery) {
  scenery.polygons.clear();
  scenery.surfaces.clear();
  const bool with_shadows = drawing.shadow_texel > 0;
  if (with_shadows) shadows.begin();
  for (const Batch& batch : drawing.batches) {
    for (std::size_t i = 0; i < batch.all; ++i) {
      if (i >= batch.visible && !with_shadows) break;
      const BodyInstance& body = drawing.bodies[batch.first + i];
      place_corners(body, meshes, batch.mesh, scenery.corners);
      if (with_shadows) throw_shadow(drawing, meshes, batch.mesh, shadows, scenery);
      if (i < batch.visible) add_body(body, meshes, batch.mesh, lens, scenery);
    }
  }
  for (const MarkInstance& mark : drawing.marks) {
    if (mark.code[0] != MarkInstance::disc) add_mark(mark, lens, scenery);
  }
  for (const LineInstance& line : drawing.lines) add_line(line, lens, scenery);
}

bool make_disc(const MarkInstance& mark, const Lens& lens, Disc& disc) {
  disc.surface.color = mark.color;
  return set_square(mark, lens, disc.square, disc.surface);
}

}  // namespace ziggurat::render
