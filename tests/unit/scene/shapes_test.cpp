// SPDX-License-Identifier: MIT
// Shapes as scenes say them: single bodies, links, hulls from vertices and from files.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numbers>

#include "scene/draft.h"
#include "scene/mesh_file.h"
#include "scene_text.h"

namespace ziggurat::scene {
namespace {

using math::Vector3;

ReadResult read(const std::string& entity, const std::string& file = "") {
  SceneText text;
  text.arena = arena_with(entity);
  ReadOptions options;
  options.open = [file](const std::filesystem::path& path,
                        std::size_t most) -> std::variant<File, std::string> {
    if (path != "folder/part.obj" && path != "folder/part.stl" && path != "folder/part.STL" &&
        path != "folder/part.txt") {
      return "does not exist";
    }
    if (file.size() > most) return too_large(most);
    return File{path.string(), file};
  };
  return read_text(text.str(), "folder/test.argos", options);
}

ReadResult read_link(const std::string& link, const std::string& file = "") {
  return read(R"(<prototype id="p"><body/><links ref="a"><link id="a" mass="2" )" + link +
                  "</links></prototype>",
              file);
}

ReadResult read_hull(const std::string& hull, const std::string& file = "") {
  return read_link("geometry=\"hull\">" + hull + "</link>", file);
}

template <class Shape>
Shape shape(const ReadResult& result) {
  EXPECT_EQ(all_problems(result), "");
  return std::get<Shape>(result.scene.entities.at(0).links.at(0).geometry);
}

std::string first_fault(const ReadResult& result) {
  const auto faults = texts_of(result, Problem::Severity::fault);
  return faults.empty() ? "" : faults[0];
}

std::string vertices(const std::vector<Vector3>& points) {
  std::string text = "<hull>";
  for (const Vector3& p : points) {
    text += fmt::format("<vertex position=\"{},{},{}\"/>", p.x(), p.y(), p.z());
  }
  return text + "</hull>";
}

std::vector<Vector3> box_corners(const Vector3& low, const Vector3& high) {
  std::vector<Vector3> points;
  for (int i = 0; i < 8; ++i) {
    points.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                        i & 4 ? high.z() : low.z());
  }
  return points;
}

TEST(Shapes, ASphereIsAnEntity) {
  const ReadResult result = read(
      R"(<sphere id="s" radius="0.05" movable="true" mass="0.2" friction="0.7"><body position="0,0,1"/><leds medium="leds"/></sphere>)");
  EXPECT_NE(first_fault(result), "");  // there is no such medium: leds are read
  const ReadResult ball =
      read(R"(<sphere id="s" radius="0.05" movable="true" mass="0.2"><body/></sphere>)");
  EXPECT_EQ(shape<Sphere>(ball).radius, 0.05);
  const Entity& entity = ball.scene.entities[0];
  EXPECT_EQ(entity.kind, EntityKind::sphere);
  EXPECT_EQ(entity.links[0].mass, 0.2);
  EXPECT_EQ(entity.links[0].surface.rolling_friction, 2e-4);
  EXPECT_TRUE(is_single(entity.kind));
  EXPECT_NE(first_fault(read(R"(<sphere id="s" movable="false"><body/></sphere>)"))
                .find("<sphere> lacks the attribute radius"),
            std::string::npos);
}

TEST(Shapes, ASphereMayBeAModelAndDistributed) {
  const ReadResult result = read(
      R"(<distribute><position method="grid" center="0,0,1" distances="1,1,1" layout="2,1,1"/>)"
      R"(<orientation method="constant" values="0,0,0"/><entity quantity="2" max_trials="1">)"
      R"(<sphere id="s" radius="0.05" movable="true" mass="0.2"/></entity></distribute>)");
  EXPECT_EQ(all_problems(result), "");
  EXPECT_EQ(result.scene.distributions.at(0).entity.kind, EntityKind::sphere);
}

TEST(Shapes, ACapsuleHasTheHeightFromEndToEnd) {
  const auto capsule =
      shape<Capsule>(read_link(R"(geometry="capsule" radius="0.1" height="0.5"/>)"));
  EXPECT_EQ(capsule.radius, 0.1);
  EXPECT_EQ(capsule.height, 0.5);
  EXPECT_EQ(reach(capsule, Vector3::UnitZ()), 0.5);
  EXPECT_EQ(reach(capsule, -Vector3::UnitZ()), 0);
  EXPECT_NEAR(reach(capsule, Vector3::UnitX()), 0.1, 1e-15);
  EXPECT_NE(first_fault(read_link(R"(geometry="capsule" radius="0.1" height="0.15"/>)"))
                .find(R"(height="0.15" of <link> is less than twice the radius)"),
            std::string::npos);
}

TEST(Shapes, AHullOfABoxIsThatBox) {
  std::vector<Vector3> points = box_corners({-1, -2, 0}, {1, 2, 3});
  points.emplace_back(0.5, 0.5, 0.5);  // inside
  points.emplace_back(0, 0, 3);        // on a face
  const Hull hull = shape<Hull>(read_hull(vertices(points)));
  const Polyhedron& polyhedron = *hull.polyhedron;
  EXPECT_EQ(polyhedron.vertices.size(), 8u);
  ASSERT_EQ(polyhedron.faces.size(), 6u);
  for (const Polyhedron::Face& face : polyhedron.faces) {
    EXPECT_EQ(face.corners.size(), 4u);
    EXPECT_NEAR(face.normal.cwiseAbs().maxCoeff(), 1, 1e-12);
  }
  EXPECT_NEAR((polyhedron.center_of_mass - Vector3(0, 0, 1.5)).norm(), 0, 1e-12);
  const Vector3 inertia = polyhedron.axes * polyhedron.inertia;
  EXPECT_NEAR((inertia - Vector3(16 + 9, 4 + 9, 4 + 16) / 12).norm(), 0, 1e-12);
  EXPECT_NEAR((bounds(hull).high - Vector3(1, 2, 3)).norm(), 0, 0);
}

TEST(Shapes, ARampHasTheMassPropertiesOfARightPrism) {
  // A right triangle a x c, extruded by b: centroid at a third, I_yz = 0, I_xz = m a c / 36.
  const double a = 0.04, b = 0.02, c = 0.016;
  const Hull hull = shape<Hull>(
      read_hull(vertices({{0, 0, 0}, {a, 0, 0}, {0, b, 0}, {a, b, 0}, {0, 0, c}, {0, b, c}})));
  const Polyhedron& ramp = *hull.polyhedron;
  EXPECT_EQ(ramp.faces.size(), 5u);
  EXPECT_NEAR((ramp.center_of_mass - Vector3(a / 3, b / 2, c / 3)).norm(), 0, 1e-15);
  const Eigen::Matrix3d axes = ramp.axes.toRotationMatrix();
  const Eigen::Matrix3d inertia = axes * ramp.inertia.asDiagonal() * axes.transpose();
  EXPECT_NEAR(inertia(0, 0), b * b / 12 + c * c / 18, 1e-12);
  EXPECT_NEAR(inertia(1, 1), a * a / 18 + c * c / 18, 1e-12);
  EXPECT_NEAR(inertia(2, 2), a * a / 18 + b * b / 12, 1e-12);
  EXPECT_NEAR(inertia(0, 2), a * c / 36, 1e-12);
  EXPECT_NEAR(inertia(0, 1), 0, 1e-15);
}

TEST(Shapes, AHullComesFromAFile) {
  const std::string obj =
      "# a tetrahedron\nv 0 0 0\nv 1000 0 0\nv 0 1000 0\nv 0 0 1000\n"
      "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const Hull from_obj = shape<Hull>(read_hull(R"(<hull file="part.obj" scale="0.001"/>)", obj));
  EXPECT_EQ(from_obj.polyhedron->faces.size(), 4u);
  EXPECT_EQ(bounds(from_obj).high, Vector3(1, 1, 1));

  const std::string stl = R"(solid s
facet normal 0 0 -1 outer loop vertex 0 0 0 vertex 0 1 0 vertex 1 0 0 endloop endfacet
facet normal 0 -1 0 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 0 1 endloop endfacet
facet normal 1 1 1 outer loop vertex 1 0 0 vertex 0 1 0 vertex 0 0 1e0 endloop endfacet
endsolid s)";
  EXPECT_EQ(shape<Hull>(read_hull(R"(<hull file="part.stl"/>)", stl)).polyhedron->vertices.size(),
            4u);

  std::string binary(84, ' ');
  binary[80] = 2;
  binary[81] = binary[82] = binary[83] = 0;
  const auto number = [&](float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (int i = 0; i < 4; ++i) binary += static_cast<char>(bits >> (8 * i) & 0xff);
  };
  for (const float z : {0.0f, 0.5f}) {
    for (const float value : {0.f, 0.f, 1.f, 0.f, 0.f, z, 1.f, 0.f, z, 0.f, 1.f, z}) number(value);
    binary += "ab";
  }
  const Hull prism = shape<Hull>(read_hull(R"(<hull file="part.STL"/>)", binary));
  EXPECT_EQ(prism.polyhedron->faces.size(), 5u);
  EXPECT_EQ(bounds(prism).high.z(), 0.5);
}

TEST(Shapes, WhatIsNoHullIsAFaultThatSaysWhy) {
  const std::string flat = vertices({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 2, 0}});
  std::vector<Vector3> round;
  for (int i = 0; i < 65; ++i) {
    const double angle = 2 * std::numbers::pi * i / 65;
    round.emplace_back(std::cos(angle), std::sin(angle), i % 2);
  }
  std::string binary =
      std::string(80, ' ') + std::string("\3\0\0\0", 4) + std::string(2 * 50, '\0');
  const std::string big = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1e7\n";
  struct Row {
    std::string hull, file, fault;
  };
  const Row rows[] = {
      {"", "", "<link> lacks the element <hull>"},
      {"<hull/>", "", "<hull> has no volume; write at least 4 vertices"},
      {flat, "", "<hull> has no volume"},
      {vertices(round), "", "<hull> has 65 corners; at most 64 are allowed"},
      {R"(<hull><vertex/></hull>)", "", "<vertex> lacks the attribute position"},
      {R"(<hull><point position="1,1,1"/></hull>)", "", "unknown element <point> in <hull>"},
      {R"(<hull file="other.obj"/>)", "", R"(names "folder/other.obj", which does not exist)"},
      {R"(<hull file="../part.obj"/>)", big, "leads out of its folder"},
      {R"(<hull file="/part.obj"/>)", big, "leads out of its folder"},
      {R"(<hull file="part.txt"/>)", big, "is neither an .obj nor an .stl file"},
      {R"(<hull file="part.obj"/>)", "nothing", "has no vertices"},
      {R"(<hull file="part.obj"/>)", big, "farther than 1e6 from the origin"},
      {R"(<hull file="part.obj"/>)", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "<hull> has no volume"},
      {R"(<hull file="part.stl"/>)", "vertex 1 2 x", "vertex 1 has no three numbers"},
      {R"(<hull file="part.stl"/>)", binary,
       "is no whole STL file: it ends within triangle 3 of 3; export it"},
      {R"(<hull file="part.stl"/>)", binary.substr(0, 133), "it ends within triangle 1 of 3"},
      {R"(<hull file="part.stl"/>)", binary + std::string(51, 'x'),
       "tells of 3 triangles, and 1 bytes stand behind"},
      {R"(<hull file="part.stl"/>)", std::string(60, '\0'),
       "it ends within its header, after 60 of 84 bytes"},
      {R"(<hull file="part.stl"/>)", "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nvertex 1 1 1",
       "it ends within triangle 2"},
      {R"(<hull file="part.obj"/>)", "v 0 0 0\r\nv 1 0 0\r\n  v 0 1",
       "the vertex in line 3 has no three numbers"},
      {R"(<hull file="part.obj"/>)", std::string(most_mesh_bytes + 1, '#'),
       "which is larger than 16 MiB; write one with fewer"},
      {R"(<hull file="part.obj" scale="0"/>)", big, R"(scale="0" of <hull> is not positive)"},
      {R"(<hull file="part.obj"><vertex position="0,0,0"/></hull>)", "v 0 0 0",
       "its vertices are those of the file"},
  };
  for (const Row& row : rows) {
    std::string all;
    for (const auto& fault : texts_of(read_hull(row.hull, row.file), Problem::Severity::fault)) {
      all += fault + "\n";
    }
    EXPECT_NE(all.find(row.fault), std::string::npos) << row.hull.substr(0, 80) << "\n" << all;
  }
}

TEST(Shapes, ExtentsOfOtherShapesHaveNoEffect) {
  const ReadResult result = read_link(R"(geometry="sphere" radius="0.1" height="0.5"/>)");
  EXPECT_TRUE(result.ok());
  EXPECT_NE(all_problems(result).find("height of <link> has no effect here"), std::string::npos);
  EXPECT_NE(first_fault(read_link(R"(geometry="box" size="1,1,1"><hull/></link>)"))
                .find("unknown element <hull> in <link>"),
            std::string::npos);
  EXPECT_NE(first_fault(read_link(R"(geometry="ball" radius="1"/>)"))
                .find("write one of: box, cylinder, sphere, capsule, hull"),
            std::string::npos);
}

}  // namespace
}  // namespace ziggurat::scene
