// SPDX-License-Identifier: MIT
#include "render/meshes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

namespace ziggurat::render {
namespace {

using Vector = Eigen::Vector3d;

Vector vector(const std::array<float, 3>& xyz) { return {xyz[0], xyz[1], xyz[2]}; }

struct Measure {
  double volume = 0;      // by the divergence theorem: negative if triangles are inside out
  double worst_turn = 1;  // least cosine between a triangle and the normals at its corners
};

Measure measure(const Meshes& meshes, const Mesh& mesh) {
  Measure result;
  for (std::size_t i = 0; i < mesh.indices; i += 3) {
    std::array<Vertex, 3> corner;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto index =
          std::size_t{mesh.first_vertex} + meshes.indices.at(mesh.first_index + i + c);
      corner[c] = meshes.vertices.at(index);
    }
    const Vector a = vector(corner[0].position), b = vector(corner[1].position),
                 c = vector(corner[2].position);
    result.volume += a.dot(b.cross(c)) / 6;
    const Vector across = (b - a).cross(c - a);
    if (across.norm() < 1e-9) continue;  // at a sphere's poles
    for (const Vertex& vertex : corner) {
      result.worst_turn =
          std::min(result.worst_turn, across.normalized().dot(vector(vertex.normal)));
    }
  }
  return result;
}

TEST(Meshes, AreClosedWithOutwardNormals) {
  const Meshes meshes = make_meshes();
  const Measure box = measure(meshes, meshes.box);
  EXPECT_NEAR(box.volume, 1, 1e-6);
  EXPECT_NEAR(box.worst_turn, 1, 1e-6);
  for (std::size_t i = 0; i < roundness.size(); ++i) {
    const double n = roundness[i];
    const Measure cylinder = measure(meshes, meshes.cylinders[i]);
    const double polygon = n / 2 * std::sin(2 * std::numbers::pi / n);  // area, radius 1
    EXPECT_NEAR(cylinder.volume, polygon, 1e-5);
    EXPECT_NEAR(cylinder.worst_turn, std::cos(std::numbers::pi / n), 1e-5);
    const Measure sphere = measure(meshes, meshes.spheres[i]);
    EXPECT_NEAR(sphere.volume, 4.0 / 3.0 * std::numbers::pi, 80 / (n * n));
    EXPECT_GT(sphere.worst_turn, std::cos(2 * std::numbers::pi / n));
  }
}

TEST(Meshes, AHullIsClosedAndOutwards) {
  const scene::Hull ramp = std::get<scene::Hull>(scene::make_hull(std::vector<math::Vector3>{
      {0, 0, 0}, {4, 0, 0}, {0, 2, 0}, {4, 2, 0}, {0, 0, 1}, {0, 2, 1}}));
  Meshes meshes = make_meshes();
  const Measure hull = measure(meshes, add_hull(*ramp.polyhedron, meshes));
  EXPECT_NEAR(hull.volume, 4, 1e-6);
  EXPECT_NEAR(hull.worst_turn, 1, 1e-6);
}

TEST(RoundnessFor, DeviatesFromACircleByATwentiethOfAPixelAtMost) {
  EXPECT_EQ(roundness_for(0), 0u);
  for (const double radius : {1.0, 10.0, 100.0, 600.0}) {
    const double pieces = roundness[roundness_for(radius)];
    EXPECT_LE(radius * (1 - std::cos(std::numbers::pi / pieces)), 0.05) << radius;
  }
  EXPECT_EQ(roundness_for(1e9), roundness.size() - 1);
}

}  // namespace
}  // namespace ziggurat::render
