// Contacts of every pair of shapes at random poses, against brute force.

#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "brute_force.h"
#include "math/random.h"

namespace ziggurat::physics::contact {
namespace {

using namespace testing;

struct Pair {
  std::string name;
  Shape a, b;
  btScalar tolerance;  ///< of distances, in least half widths
};

void PrintTo(const Pair& pair, std::ostream* out) { *out << pair.name; }

const Box cube{{0.005, 0.005, 0.005}}, slab{{0.05, 0.025, 0.01}};
const Cylinder can{0.005, 0.005}, wheel{0.02, 0.0025}, rod{0.004, 0.03};
const Sphere ball{0.005}, football{0.03};

const Pair pairs[] = {
    {"BoxPlane", slab, HalfSpace{}, 1e-9},
    {"CylinderPlane", can, HalfSpace{}, 0.02},
    {"WheelPlane", wheel, HalfSpace{}, 0.1},
    {"SpherePlane", ball, HalfSpace{}, 1e-9},
    {"SphereSphere", ball, football, 1e-9},
    {"SphereBox", ball, slab, 1e-6},
    {"BoxSphere", slab, football, 1e-6},
    {"SphereCylinder", ball, wheel, 1e-6},
    {"CylinderSphere", rod, football, 1e-6},
    {"CubeCube", cube, cube, 0.02},
    {"CubeSlab", cube, slab, 0.02},
    {"SlabSlab", slab, slab, 0.02},
    {"CylinderCube", can, cube, 0.05},
    {"SlabCylinder", slab, can, 0.05},
    {"WheelSlab", wheel, slab, 0.05},
    {"CylinderCylinder", can, can, 0.05},
    {"WheelRod", wheel, rod, 0.05},
    {"RodRod", rod, rod, 0.05},
};

btQuaternion random_rotation(math::RandomStream& random, int kind) {
  const auto part = [&] { return random.gaussian(0, 1); };
  const btQuaternion any = btQuaternion(part(), part(), part(), part()).normalized();
  if (kind % 2) return any;
  // Nearly aligned with the axes, or exactly: where degenerate poses are.
  constexpr double tilts[] = {0, 0, 1e-9, 1e-6, 1e-4, 1e-2};
  const double tilt = tilts[kind / 2 % 6];
  btQuaternion quarter = btQuaternion::getIdentity();
  for (int axis = 0; axis < 3; ++axis) {
    btVector3 about(0, 0, 0);
    about[axis] = 1;
    const double turns = std::floor(random.uniform(0, 4));
    quarter = btQuaternion(about, turns * std::numbers::pi / 2) * quarter;
  }
  const btVector3 about = btVector3(part(), part(), part()).normalized();
  return btQuaternion(about, tilt) * quarter;
}

/// A pose of A against B from well inside to well apart.
void place(math::RandomStream& random, int i, Solid& a, Solid& b) {
  const auto part = [&] { return random.gaussian(0, 1); };
  const btVector3 origin(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3));
  b.pose = btTransform(random_rotation(random, i), origin);
  a.pose = btTransform(random_rotation(random, i / 2), origin);
  btVector3 direction = btVector3(part(), part(), part()).normalized();
  if (i % 3 == 0) direction = b.pose.getBasis().getColumn(i / 3 % 3);
  if (std::holds_alternative<HalfSpace>(b.shape)) {
    const btVector3 up = b.pose.getBasis().getColumn(2);
    a.pose.setOrigin(origin + direction * 0.02);
    const btScalar gap = slab_gap(a, b, up);
    a.pose.setOrigin(a.pose.getOrigin() + up * (a.smallest() * random.uniform(-0.2, 1.5) - gap));
    return;
  }
  const btScalar touching = a.extent(direction) + b.extent(direction);
  const btScalar share = i % 7 ? random.uniform(-0.15, 0.4) : 0;
  a.pose.setOrigin(origin + direction * (touching + share * std::min(a.smallest(), b.smallest())));
}

btScalar least(const Contacts& contacts) {
  btScalar distance = BT_LARGE_FLOAT;
  for (int i = 0; i < contacts.count; ++i) distance = std::min(distance, contacts.points[i].distance);
  return distance;
}

class AllPairs : public ::testing::TestWithParam<Pair> {
 protected:
  static constexpr int poses = 150;
};

TEST_P(AllPairs, AgreeWithBruteForce) {
  const Pair& pair = GetParam();
  Solid a{pair.a, btTransform::getIdentity()}, b{pair.b, btTransform::getIdentity()};
  const btScalar size = std::min(a.smallest(), b.smallest());
  math::RandomStream random(1, pair.name);
  int touching = 0;
  double worst = 0, worst_surface = 0, worst_swap = 0; int missed = 0, high = 0, ghosts = 0; int worst_i = -1;
  for (int i = 0; i < poses; ++i) {
    place(random, i, a, b);
    const Gap gap = true_gap(a, b);
    const btScalar reach = size * 0.3;
    const Contacts contacts = find(a.shape, a.pose, b.shape, b.pose, reach);
    const Contacts swapped = find(b.shape, b.pose, a.shape, a.pose, reach);
    if (gap.distance > reach * (1 + 1e-9)) { if (contacts.count) ++ghosts; continue; }
    if (gap.distance < -0.2 * size) continue;
    ++touching;
    if (!contacts.count || !swapped.count) { ++missed; if (gap.distance < 0) ++high; continue; }
    double error = (least(contacts) - gap.distance) / size;
    if (std::fabs(error) > std::fabs(worst)) worst = error, worst_i = i;
    worst_swap = std::max<double>(worst_swap, std::fabs(least(contacts) - least(swapped)) / size);
    for (int k = 0; k < contacts.count; ++k) {
      const Point& p = contacts.points[k];
      worst_surface = std::max<double>(worst_surface, std::fabs(b.distance(p.on_b)) / size);
      worst_surface = std::max<double>(worst_surface, std::fabs(a.distance(p.on_b + contacts.normal * p.distance)) / size);
    }
    EXPECT_NEAR(contacts.normal.length(), 1, 1e-9);
  }
  printf("%-20s touching %d missed %d (overlap %d) ghosts %d worst %.4f (pose %d) surface %.4f swap %.4f\n", pair.name.c_str(), touching, missed, high, ghosts, worst, worst_i, worst_surface, worst_swap);
}

INSTANTIATE_TEST_SUITE_P(Contact, AllPairs, ::testing::ValuesIn(pairs),
                         [](const auto& pair) { return pair.param.name; });

}  // namespace
}  // namespace ziggurat::physics::contact
