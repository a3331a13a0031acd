// SPDX-License-Identifier: MIT
#pragma once
// The shapes of links as triangles: box, cylinder and sphere in sizes of one, standing on their
// bottom centre, and hulls as they are.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/geometry.h"

namespace ziggurat::render {

/// Far from any edge: a face has none along this axis.
constexpr float no_edge = 9;

struct Vertex {
  std::array<float, 3> position;  ///< of a unit box, of a cylinder or sphere of radius 1, or
                                  ///< of a hull [m]
  std::array<float, 3> normal;    ///< unit, outwards
  /// Coordinate of the vertex along each axis of the face; its edges are at -1 and 1.
  std::array<float, 3> edge;
};

/// A part of the arrays of Meshes. Triangles are counterclockwise seen from outside.
struct Mesh {
  enum class Kind { box, cylinder, sphere, hull };
  Kind kind = Kind::box;
  std::uint32_t first_index = 0, indices = 0;
  std::uint32_t first_vertex = 0, vertices = 0;
};

/// Resolution of a round shape: number of straight pieces around it.
constexpr std::array<unsigned, 5> roundness{16, 32, 64, 128, 256};

struct Meshes {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;

  Mesh box;
  std::array<Mesh, roundness.size()> cylinders, spheres;  ///< by place in `roundness`
};

Meshes make_meshes();

/// Adds a hull in its own frame and size.
Mesh add_hull(const scene::Polyhedron& hull, Meshes& meshes);

/// Place in `roundness` for a radius in pixels, so that straight pieces are not visible.
std::size_t roundness_for(double radius);

}  // namespace ziggurat::render
