// SPDX-License-Identifier: MIT
// Reduction of a contact's points to four, and contacts at nearly degenerate resting poses.

#include <gtest/gtest.h>

#include <numbers>

#include "brute_force.h"
#include "math/random.h"

namespace ziggurat::physics::contact {
namespace {

using testing::can;
using testing::cube;

btTransform at(btScalar x, btScalar y, btScalar z, const btVector3& axis = {0, 0, 1},
               btScalar angle = 0) {
  return btTransform(btQuaternion(axis, angle), btVector3(x, y, z));
}

/// Twice the area that points of a contact span, as seen along z [m^2].
btScalar area(const Manifold& contacts) {
  btScalar twice = 0;
  for (int i = 0; i < contacts.count; ++i) {
    const btVector3& p = contacts.points[i].on_b;
    const btVector3& q = contacts.points[(i + 1) % contacts.count].on_b;
    twice += p.x() * q.y() - p.y() * q.x();
  }
  return std::fabs(twice);
}

TEST(Reduce, KeepsTheDeepestAndAtMostFour) {
  math::RandomStream random(1, "reduce");
  for (int round = 0; round < 300; ++round) {
    Manifold contacts;
    contacts.normal = {0, 0, 1};
    const int count = static_cast<int>(random.uniform(1, Manifold::capacity + 0.99));
    btScalar deepest = 1;
    for (int i = 0; i < count; ++i) {
      const btScalar distance = random.uniform(-1e-3, 1e-3);
      deepest = std::min(deepest, distance);
      contacts.add({random.uniform(-0.01, 0.01), random.uniform(-0.01, 0.01), 0}, distance);
    }
    reduce(contacts, at(0, 0, 0));
    EXPECT_EQ(contacts.count <= 4, true);
    btScalar kept = 1;
    for (int i = 0; i < contacts.count; ++i) kept = std::min(kept, contacts.points[i].distance);
    EXPECT_LE(kept, deepest + 1e-6);
  }
}

TEST(Reduce, IsStableUnderRounding) {
  math::RandomStream random(1, "perturb");
  // Twelve points on a regular outline at the same depth, from any of them on: every choice is a
  // tie.
  const auto ring = [&](btScalar noise, int first = 0) {
    constexpr btScalar pressed_in = 1e-7;  // as far as loads press bodies in [m]
    Manifold contacts;
    contacts.normal = {0, 0, 1};
    for (int i = first; i < first + 12; ++i) {
      const double angle = i * std::numbers::pi / 6 + 0.05;
      contacts.add({0.01 * std::cos(angle) + noise * random.uniform(-1, 1),
                    0.01 * std::sin(angle) + noise * random.uniform(-1, 1), 0},
                   noise > 0 ? pressed_in * random.uniform(-1, 1) : 0);
    }
    reduce(contacts, at(0, 0, 0));
    return contacts;
  };
  const Manifold exact = ring(0);
  for (int round = 0; round < 100; ++round) {
    const Manifold noisy = ring(1e-13, round % 12);
    ASSERT_EQ(noisy.count, exact.count);
    for (int i = 0; i < exact.count; ++i) {
      EXPECT_LT((noisy.points[i].on_b - exact.points[i].on_b).length(), 1e-9);
    }
  }
}

struct Face {
  const char* name;
  Shape a, b;
  btScalar least_area;  ///< of the shared face [m^2]
};

TEST(Faces, ShareAtLeastThreePointsThatSpanTheOverlap) {
  const Face faces[] = {{"cube on cube", cube, cube, 1e-4},
                        {"can on cube", can, cube, 2 * 25e-6},
                        {"cube on can", cube, can, 2 * 25e-6},
                        {"can on can", can, can, 2 * 25e-6}};
  for (const Face& face : faces) {
    for (const btScalar gap : {-5e-4, -1e-9, 0.0, 1e-9, 5e-4}) {
      for (const btScalar turn : {0.0, 1e-9, 0.1, 0.7853981633974483}) {
        Manifold contacts =
            find(face.a, at(0, 0, 0.01 + gap, {0, 0, 1}, turn), face.b, at(0, 0, 0), 1e-3);
        reduce(contacts, at(0, 0, 0));
        SCOPED_TRACE(::testing::Message() << face.name << ", gap " << gap << ", turn " << turn);
        EXPECT_GE(contacts.count, 3);
        EXPECT_NEAR(contacts.normal.z(), 1, 1e-6);
        EXPECT_GT(area(contacts), 0.65 * 2 * face.least_area / 2);
        for (int i = 0; i < contacts.count; ++i)
          EXPECT_NEAR(contacts.points[i].distance, gap, 1e-9);
      }
    }
  }
}

TEST(Lines, ALyingCylinderTouchesAlongItsSide) {
  const btScalar quarter = std::numbers::pi / 2;
  const btTransform lying = at(0, 0, 0.01, {1, 0, 0}, quarter);
  for (const Shape& below : {Shape(HalfSpace{}), Shape(cube), Shape(can)}) {
    const bool plane = std::holds_alternative<HalfSpace>(below);
    const Manifold contacts = find(can, lying, below, at(0, 0, plane ? 0.005 : 0), 1e-3);
    EXPECT_GE(contacts.count, 2);
    for (int i = 0; i < contacts.count; ++i) EXPECT_NEAR(contacts.points[i].distance, 0, 1e-9);
  }
  const Manifold parallel = find(can, lying, can, at(0, 0, 0, {1, 0, 0}, quarter), 1e-3);
  EXPECT_EQ(parallel.count, 2);
}

// GJK finds no direction where they touch, and one between the faces of the edge where their cores
// are shrunk.
TEST(Lines, ALyingCylinderTouchesAnEdgeThatIsJustBesideItsLine) {
  const btScalar radius = 0.05, quarter = std::numbers::pi / 2;
  const Cylinder log{radius, 0.05};
  const Box table{{0.15, 0.2, 0.05}};
  for (const btScalar above : {-1e-7, -1e-9, 0.0, 1e-9}) {
    for (const btScalar beyond : {0.0, 1e-10, 1e-9, 3e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4}) {
      for (const btScalar turn : {0.0, 1e-8, 1e-4}) {
        SCOPED_TRACE(::testing::Message()
                     << "above " << above << ", beyond " << beyond << ", turn " << turn);
        btTransform pose = at(0.15 + beyond, 0.03, 0.05 + radius + above, {0, 0, 1}, turn);
        pose.setRotation(pose.getRotation() * btQuaternion(btVector3(1, 0, 0), quarter));
        const Manifold contacts = find(log, pose, table, at(0, 0, 0), 1e-3, Support::face);
        EXPECT_EQ(contacts.count, 2);
        EXPECT_NEAR(contacts.normal.z(), 1, 1e-4);
        const btScalar off = std::abs(beyond) + 0.05 * turn;  // of one end
        for (int i = 0; i < contacts.count; ++i) {
          EXPECT_GT(contacts.points[i].distance, above - 1e-9);
          EXPECT_LT(contacts.points[i].distance, above + off * off / radius + 1e-9);
        }
      }
    }
  }
}

TEST(Edges, OfCrossedBoxesTouchAtOnePoint) {
  const btScalar eighth = std::numbers::pi / 4;
  const btScalar edge = 0.005 * std::numbers::sqrt2;
  const Manifold contacts = find(cube, at(0, 0, 2 * edge + 1e-4, {1, 0, 0}, eighth), cube,
                                 at(0, 0, 0, {0, 1, 0}, eighth), 1e-3);
  ASSERT_EQ(contacts.count, 1);
  EXPECT_NEAR(contacts.points[0].distance, 1e-4, 1e-9);
  EXPECT_NEAR((contacts.points[0].on_b - btVector3(0, 0, edge)).length(), 0, 1e-9);
}

/// Two cards that lean on each other by 0.3 rad; their upper edges meet in the origin.
/// @param up  how much higher the edge of A is [m]
Manifold of_leaning_cards(btScalar up) {
  const Box card{{0.03, 0.0005, 0.04}};
  const btScalar lean = 0.3;
  const auto pose = [&](btScalar side, btScalar z) {
    const btTransform turn = at(0, 0, 0, {1, 0, 0}, side * lean);
    return btTransform(turn.getBasis(),
                       btVector3(0, 0, z) - turn * btVector3(0, -side * 0.0005, 0.04));
  };
  return find(card, pose(-1, up), card, pose(1, 0), 1e-3, Support::face);
}

TEST(Edges, ThatLieAlongEachOtherHaveANormalBetweenTheirFaces) {
  const Manifold contacts = of_leaning_cards(0);
  ASSERT_EQ(contacts.count, 2);
  EXPECT_NEAR((contacts.normal - btVector3(0, -1, 0)).length(), 0, 1e-9);
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(contacts.points[i].distance, 0, 1e-12);
    EXPECT_NEAR(btFabs(contacts.points[i].on_b.x()), 0.03, 1e-12);
  }
}

TEST(Edges, ChangeFromTheNormalOfOneFaceToThatOfTheOtherWithoutAJump) {
  btScalar before = 0;
  for (int i = -100; i <= 100; ++i) {
    const Manifold contacts = of_leaning_cards(i * 2e-8);
    ASSERT_EQ(contacts.count, 2) << i;
    const btScalar tilt = std::atan2(contacts.normal.z(), -contacts.normal.y());
    if (i == -100) before = tilt;
    EXPECT_NEAR(tilt, before, 0.05) << i;
    before = tilt;
    for (int k = 0; k < 2; ++k) EXPECT_LT(btFabs(contacts.points[k].distance), 1e-6) << i;
  }
  EXPECT_NEAR(before, 0.3, 1e-3);
}

TEST(Concentric, BodiesHaveAFinitePenetrationDepth) {
  const Shape shapes[] = {cube, can, Sphere{0.005}, Box{{0.05, 0.02, 0.01}}};
  for (const Shape& a : shapes) {
    for (const Shape& b : shapes) {
      const Manifold contacts = find(a, at(0, 0, 0), b, at(0, 0, 0), 1e-3);
      ASSERT_GT(contacts.count, 0);
      EXPECT_NEAR(contacts.normal.length(), 1, 1e-9);
      for (int i = 0; i < contacts.count; ++i) {
        EXPECT_TRUE(std::isfinite(contacts.points[i].distance));
        EXPECT_LT(contacts.points[i].distance, 0);
      }
    }
  }
}

}  // namespace
}  // namespace ziggurat::physics::contact
