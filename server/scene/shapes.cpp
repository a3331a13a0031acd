// SPDX-License-Identifier: MIT
// The shape of a link or of a single body: attributes, and for a hull its corners.

#include <algorithm>
#include <array>
#include <filesystem>
#include <span>

#include "scene/draft.h"
#include "scene/files.h"
#include "scene/mesh_file.h"

namespace ziggurat::scene {
namespace {

Box read_box(Draft&, Element& element) {
  return {element.required("size", size, math::Vector3::Ones())};
}

Cylinder read_cylinder(Draft&, Element& element) {
  const double radius = element.required("radius", length, 1.0);
  return {radius, element.required("height", length, 1.0)};
}

Sphere read_sphere(Draft&, Element& element) { return {element.required("radius", length, 1.0)}; }

Capsule read_capsule(Draft&, Element& element) {
  const double radius = element.required("radius", length, 1.0);
  const double height = element.required("height", length, 2 * radius);
  if (height < 2 * radius) {
    element.fault_at("height", fmt::format("is less than twice the radius; height is from end to "
                                           "end, so write at least {}",
                                           2 * radius));
  }
  return {radius, height};
}

/// The positions of these elements.
std::vector<math::Vector3> positions_of(std::span<Element> elements) {
  std::vector<math::Vector3> points;
  for (Element& element : elements) {
    points.push_back(element.required("position", position));
    element.done();
  }
  return points;
}

std::vector<math::Vector3> listed_vertices(Element& hull) {
  constexpr std::string_view known[] = {"vertex"};
  std::vector<Element> vertices = hull.children();
  std::erase_if(vertices, [&](const Element& vertex) {
    if (vertex.name() != "vertex") vertex.unknown_in("hull", known);
    return vertex.name() != "vertex";
  });
  return positions_of(vertices);
}

/// The vertices in a file, times `scale`.
std::vector<math::Vector3> read_vertices(Draft& draft, Element& hull) {
  const std::filesystem::path written = hull.required("file", path);
  const double scale = hull.optional("scale", positive, 1.0);
  if (written.empty()) return {};
  if (!stays_inside(written)) {
    hull.fault_at("file",
                  "leads out of its folder; write a path without .. that is relative to "
                  "the file it is written in");
    return {};
  }
  const std::filesystem::path path = folder_of(draft.scene, hull.where()) / written;
  const std::size_t most = std::min(most_mesh_bytes, draft.budget.bytes);
  auto opened = draft.options.open(path, most);
  if (std::string* why = std::get_if<std::string>(&opened)) {
    if (most == most_mesh_bytes && *why == too_large(most)) {
      *why = fmt::format(
          "is larger than {} MiB; write one with fewer triangles (a hull has at most {} corners)",
          most_mesh_bytes >> 20, Hull::most_vertices);
    }
    hull.fault_at("file", fmt::format("names {}, which {}", in_quotes(path.string()), *why));
    return {};
  }
  const std::string& bytes = std::get<File>(opened).text;
  draft.budget.bytes -= std::min(bytes.size(), draft.budget.bytes);
  auto points = read_mesh(written, bytes);
  if (const std::string* why = std::get_if<std::string>(&points)) {
    hull.fault_at("file", *why);
    return {};
  }
  for (math::Vector3& point : std::get<0>(points)) point *= scale;
  return std::get<0>(std::move(points));
}

Hull unit_hull() {
  constexpr double corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::vector<math::Vector3> points;
  for (const auto& [x, y, z] : corners) points.emplace_back(x, y, z);
  return std::get<Hull>(make_hull(points));
}

/// The points of a convex_hull of other versions: `(x,y,z)(x,y,z)…` as the link's text.
std::vector<math::Vector3> points_in_text(const Element& link, std::string_view left) {
  std::vector<math::Vector3> points;
  while (!left.empty()) {
    const std::size_t end = left.find(')');
    auto point = left.front() == '(' && end != left.npos ? position(left.substr(1, end - 1))
                                                         : Wrong{"is no list of points"};
    if (const Wrong* wrong = std::get_if<Wrong>(&point)) {
      link.fault(fmt::format(
          "has the text {}, which {}; write (x,y,z)(x,y,z)…, or <hull> with a <vertex> for each",
          in_quotes(left), wrong->text));
      return {};
    }
    points.push_back(std::get<0>(point));
    left = trimmed(left.substr(end + 1));
  }
  return points;
}

/// @param from  the element that has the points
Hull hull_of(const Element& from, const std::vector<math::Vector3>& points) {
  auto hull = make_hull(points);
  if (Hull* made = std::get_if<Hull>(&hull)) return std::move(*made);
  from.fault(std::get<std::string>(hull));
  return unit_hull();
}

/// The `<point>`s of a convex_hull of other versions, in the link or in `<points>` of it.
std::vector<math::Vector3> listed_points(Element& link) {
  std::vector<Element> points = link.children("point");
  if (auto list = link.child("points")) {
    const std::vector<Element> more = list->children("point");
    points.insert(points.end(), more.begin(), more.end());
    list->done();
  }
  return positions_of(points);
}

Hull read_hull(Draft& draft, Element& element) {
  if (const auto points = listed_points(element); !points.empty()) return hull_of(element, points);
  if (const std::string_view text = trimmed(element.take_text());
      !text.empty() && !element.child("hull")) {
    const auto points = points_in_text(element, text);
    return points.empty() ? unit_hull() : hull_of(element, points);
  }
  auto child = element.required_child("hull");
  if (!child) return unit_hull();
  const bool from_file = child->has("file");
  if (!from_file) child->optional("file", path);
  const auto points = from_file ? read_vertices(draft, *child) : listed_vertices(*child);
  child->done(from_file ? "its vertices are those of the file" : "");
  if (from_file && points.empty()) return unit_hull();  // reported already
  return hull_of(*child, points);
}

/// A shape as attributes name it.
struct Named {
  std::string_view name;
  Geometry (*read)(Draft&, Element&);
};

template <auto read>
Geometry as_geometry(Draft& draft, Element& element) {
  return read(draft, element);
}

constexpr std::array<Named, std::variant_size_v<Geometry>> shapes{{
    {"box", as_geometry<read_box>},
    {"cylinder", as_geometry<read_cylinder>},
    {"sphere", as_geometry<read_sphere>},
    {"capsule", as_geometry<read_capsule>},
    {"hull", as_geometry<read_hull>},
}};

}  // namespace

Geometry read_shape(Draft& draft, Element& element, std::string_view name) {
  const auto shape = std::ranges::find(shapes, name, &Named::name);
  return shape->read(draft, element);
}

Geometry read_geometry(Draft& draft, Element& link) {
  std::vector<std::string_view> names;
  for (const Named& shape : shapes) names.push_back(shape.name);
  const auto name = needed(link, "geometry", Words(names));
  if (!name) {
    for (const char* extent : {"size", "radius", "height"}) link.optional(extent, text);
    link.child("hull");
    return Box{math::Vector3::Ones()};
  }
  const Geometry geometry = read_shape(draft, link, *name);
  constexpr std::string_view why = "the geometry has no such extent";
  const std::vector<std::string> asked = link.asked();
  const auto was_asked = [&](const char* attribute) {
    return std::ranges::find(asked, attribute) != asked.end();
  };
  if (!was_asked("size")) link.without_effect("size", vector3, why);
  for (const char* extent : {"radius", "height"}) {
    if (!was_asked(extent)) link.without_effect(extent, number, why);
  }
  return geometry;
}

}  // namespace ziggurat::scene
