// SPDX-License-Identifier: MIT
// Cylinders and planks, whose contact points the test makes itself.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "touching.h"

namespace ziggurat::dynamics {
namespace {

using testing::at;
using testing::g;
using testing::Touching;

/// Points on the rim of each cylinder's lower face, against the upper face of the one below.
std::vector<ContactPoint> rims(const System& system, double radius, double height,
                               const std::vector<ContactPoint>& before) {
  std::vector<ContactPoint> out;
  for (int i = 0; i < static_cast<int>(system.trees.size()); ++i) {
    const Tree& tree = system.trees[i];
    Vector3 top = Vector3::Zero(), normal = Vector3::UnitZ();
    if (i > 0) {
      const Tree& below = system.trees[i - 1];
      normal = below.rotation[0].col(2);
      top = below.position[0] + normal * (height / 2);
    }
    for (int k = 0; k < 8; ++k) {
      const double angle = k * M_PI / 4;
      const Vector3 local(radius * std::cos(angle), radius * std::sin(angle), -height / 2);
      const Vector3 point = tree.position[0] + tree.rotation[0] * local;
      ContactPoint contact;
      contact.a.tree = i, contact.b.tree = i - 1;
      contact.normal = normal;
      contact.gap = normal.dot(point - top);
      contact.point = point - normal * contact.gap;
      contact.friction = 0.5;
      if (out.size() < before.size()) contact.impulse = before[out.size()].impulse;
      out.push_back(contact);
    }
  }
  return out;
}

TEST(Shape, ATowerOfCylindersStands) {
  const double radius = 0.005, height = 0.01, mass = 1e-3;
  System system;
  system.sleeping.enabled = false;
  for (int i = 0; i < 20; ++i) {
    Link link;
    link.mass = mass;
    const double across = mass * (3 * radius * radius + height * height) / 12;
    link.inertia = Vector3(across, across, mass * radius * radius / 2);
    system.trees.emplace_back(std::vector<Link>{link}, at(0, 0, height * (i + 0.5)));
    testing::weigh(system.trees.back());
  }
  std::vector<ContactPoint> contacts;
  for (int i = 0; i < 1000; ++i) {
    contacts = rims(system, radius, height, contacts);
    ASSERT_EQ(system.step(0.01, contacts).not_converged, 0) << i;
  }
  const Vector3 drift = system.trees[19].position[0] - Vector3(0, 0, height * 19.5);
  std::printf("20 cylinders of 1 cm drift %.1e m in 10 s\n", drift.norm());
  EXPECT_LT(drift.norm(), 1e-6);
}

// Planks that fall on the floor at random end flat on it, within its level.
TEST(Shape, PlanksLieOnTheFloor) {
  Touching world;
  world.planes.push_back({Vector3::Zero(), Vector3::UnitZ()});
  const Vector3 sides(0.2, 0.05, 0.01);
  std::mt19937 random(5);
  const auto draw = [&] { return random() / 2147483647.5 - 1; };
  for (int i = 0; i < 50; ++i) {
    double turn[4];
    for (double& value : turn) value = draw();
    const Quaternion q = Quaternion(turn[0], turn[1], turn[2], turn[3]).normalized();
    world.add_box(sides, 0.1, {Vector3(i % 10, i / 10, 0.3), q}, 0.5);
  }
  for (int i = 0; i < 400; ++i) world.step(0.01);
  double worst = 0;
  for (int i = 0; i < 50; ++i) {
    const testing::OrientedBox box = world.shape(i);
    for (const Vector3& corner : testing::face_towards(box, -Vector3::UnitZ())) {
      worst = std::max(worst, std::abs(corner.z()));
    }
  }
  std::printf("planks: worst corner %.1e m from the floor\n", worst);
  EXPECT_LT(worst, 5e-4);
}

}  // namespace
}  // namespace ziggurat::dynamics
