// SPDX-License-Identifier: MIT
#include "render/meshes.h"

#include <cmath>
#include <numbers>

namespace ziggurat::render {
namespace {

Mesh begin(Mesh::Kind kind, const Meshes& meshes) {
  return {kind, static_cast<std::uint32_t>(meshes.indices.size()), 0,
          static_cast<std::uint32_t>(meshes.vertices.size()), 0};
}

Mesh finished(Mesh mesh, const Meshes& meshes) {
  mesh.indices = static_cast<std::uint32_t>(meshes.indices.size()) - mesh.first_index;
  mesh.vertices = static_cast<std::uint32_t>(meshes.vertices.size()) - mesh.first_vertex;
  return mesh;
}

void add_triangle(Meshes& meshes, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  for (const std::uint32_t index : {a, b, c}) meshes.indices.push_back(index);
}

Mesh add_box(Meshes& meshes) {
  const Mesh mesh = begin(Mesh::Kind::box, meshes);
  std::uint32_t next = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;  // u x v is along the axis
      for (const auto& [s, t] :
           {std::array{-1.0f, -1.0f}, {1.0f, -1.0f}, {1.0f, 1.0f}, {-1.0f, 1.0f}}) {
        Vertex vertex{};
        vertex.normal[axis] = side;
        vertex.edge[axis] = no_edge;
        vertex.edge[u] = s;
        vertex.edge[v] = t;
        vertex.position[axis] = side / 2;
        vertex.position[u] = s / 2;
        vertex.position[v] = t / 2;
        vertex.position[2] += 0.5f;
        meshes.vertices.push_back(vertex);
      }
      const std::uint32_t second = side > 0 ? next + 1 : next + 3;
      const std::uint32_t fourth = side > 0 ? next + 3 : next + 1;
      add_triangle(meshes, next, second, next + 2);
      add_triangle(meshes, next, next + 2, fourth);
      next += 4;
    }
  }
  return finished(mesh, meshes);
}

Mesh add_cylinder(Meshes& meshes, unsigned pieces) {
  const Mesh mesh = begin(Mesh::Kind::cylinder, meshes);
  for (unsigned i = 0; i < pieces; ++i) {
    const double angle = 2 * std::numbers::pi * i / pieces;
    const auto x = static_cast<float>(std::cos(angle)), y = static_cast<float>(std::sin(angle));
    for (const float z : {0.0f, 1.0f}) {
      meshes.vertices.push_back({{x, y, z}, {x, y, 0}, {no_edge, no_edge, 2 * z - 1}});
    }
    for (const float z : {0.0f, 1.0f}) {
      meshes.vertices.push_back({{x, y, z}, {0, 0, 2 * z - 1}, {1, no_edge, no_edge}});
    }
    const std::uint32_t here = 4 * i, next = 4 * ((i + 1) % pieces);
    add_triangle(meshes, here, next, next + 1);
    add_triangle(meshes, here, next + 1, here + 1);
    const std::uint32_t middle = 4 * pieces;
    add_triangle(meshes, middle, next + 2, here + 2);
    add_triangle(meshes, middle + 1, here + 3, next + 3);
  }
  for (const float z : {0.0f, 1.0f}) {
    meshes.vertices.push_back({{0, 0, z}, {0, 0, 2 * z - 1}, {0, no_edge, no_edge}});
  }
  return finished(mesh, meshes);
}

Mesh add_sphere(Meshes& meshes, unsigned pieces) {
  const Mesh mesh = begin(Mesh::Kind::sphere, meshes);
  const unsigned rows = pieces / 2;
  for (unsigned row = 0; row <= rows; ++row) {
    const double latitude = std::numbers::pi * (static_cast<double>(row) / rows - 0.5);
    for (unsigned i = 0; i < pieces; ++i) {
      const double angle = 2 * std::numbers::pi * i / pieces;
      const auto x = static_cast<float>(std::cos(angle) * std::cos(latitude));
      const auto y = static_cast<float>(std::sin(angle) * std::cos(latitude));
      const auto z = static_cast<float>(std::sin(latitude));
      meshes.vertices.push_back({{x, y, z + 1}, {x, y, z}, {no_edge, no_edge, no_edge}});
    }
  }
  for (unsigned row = 0; row < rows; ++row) {
    for (unsigned i = 0; i < pieces; ++i) {
      const std::uint32_t here = row * pieces + i, next = row * pieces + (i + 1) % pieces;
      add_triangle(meshes, here, next, next + pieces);
      add_triangle(meshes, here, next + pieces, here + pieces);
    }
  }
  return finished(mesh, meshes);
}

}  // namespace

Mesh add_hull(const scene::Polyhedron& hull, Meshes& meshes) {
  const Mesh mesh = begin(Mesh::Kind::hull, meshes);
  std::uint32_t next = 0;
  for (const scene::Polyhedron::Face& face : hull.faces) {
    const auto count = static_cast<std::uint32_t>(face.corners.size());
    const Eigen::Vector3f normal = face.normal.cast<float>();
    Eigen::Vector3f middle = Eigen::Vector3f::Zero();
    const auto add = [&](const Eigen::Vector3f& at, float edge) {
      meshes.vertices.push_back({{at.x(), at.y(), at.z()},
                                 {normal.x(), normal.y(), normal.z()},
                                 {edge, no_edge, no_edge}});
    };
    for (const std::size_t corner : face.corners) {
      const Eigen::Vector3f at = hull.vertices[corner].cast<float>();
      add(at, 1);
      middle += at / static_cast<float>(count);
    }
    add(middle, 0);
    for (std::uint32_t i = 0; i < count; ++i) {
      add_triangle(meshes, next + count, next + i, next + (i + 1) % count);
    }
    next += count + 1;
  }
  return finished(mesh, meshes);
}

Meshes make_meshes() {
  Meshes meshes;
  meshes.box = add_box(meshes);
  for (std::size_t i = 0; i < roundness.size(); ++i) {
    meshes.cylinders[i] = add_cylinder(meshes, roundness[i]);
    meshes.spheres[i] = add_sphere(meshes, roundness[i]);
  }
  return meshes;
}

std::size_t roundness_for(double radius) {
  // n pieces miss a circle by radius * (pi / n)^2 / 2 at most: here by 0.05 px.
  const double pieces = std::numbers::pi * std::sqrt(radius / 0.1);
  std::size_t place = 0;
  while (place + 1 < roundness.size() && roundness[place] < pieces) ++place;
  return place;
}

}  // namespace ziggurat::render
