// SPDX-License-Identifier: MIT
// Links on fixed joints: mass, balance and inertia of the combined body, against closed forms.

#include <gtest/gtest.h>

#include <cmath>

#include "bench_scene.h"
#include "physics/collision/ray.h"

namespace ziggurat::physics {
namespace {

using namespace testing;
using math::Pose;
using math::Quaternion;
using math::Vector3;

scene::Joint join(scene::JointType type, std::size_t parent, const Pose& parent_frame,
                  std::size_t child, const Pose& child_frame = {},
                  const Vector3& axis = Vector3::UnitZ()) {
  scene::Joint made = joint(type, axis, parent_frame, child_frame);
  made.parent = parent;
  made.child = child;
  return made;
}

scene::Joint weld(std::size_t parent, const Pose& parent_frame, std::size_t child,
                  const Pose& child_frame = {}) {
  return join(scene::JointType::fixed, parent, parent_frame, child, child_frame);
}

/// A piece of a body: a box, given by the pose of its centre.
struct Piece {
  Pose centre;
  Vector3 size;
  double mass;

  scene::Link link(const std::string& id) const {
    return testing::link(id, scene::Box{size}, mass);
  }
  Pose bottom() const { return centre * at(0, 0, -size.z() / 2); }
  /// About an axis through the origin [kg m^2].
  double inertia(const Vector3& axis) const {
    const Vector3 squares = size.cwiseAbs2();
    const Vector3 own = mass / 12 * (Vector3::Constant(squares.sum()) - squares);
    const Vector3 along = centre.orientation.conjugate() * axis;
    return own.dot(along.cwiseAbs2()) + mass * axis.cross(centre.position).squaredNorm();
  }
};

/// An irregular body: no axis of any piece is a principal axis of the whole.
const std::vector<Piece> crooked = {
    {{{0.1, 0.02, -0.03}, about({1, 2, 3}, 0.7)}, {0.1, 0.2, 0.05}, 0.8},
    {{{-0.15, 0.1, 0.05}, about({0, 1, 1}, -0.4)}, {0.05, 0.06, 0.3}, 0.5},
    {{{0.05, -0.2, 0.1}, about({1, 0, 0}, 1.3)}, {0.1, 0.1, 0.1}, 0.3},
};

/// The pieces welded in a row. The first is on a joint of a fixed base, in whose frame all poses
/// are.
scene::Entity hung(const std::vector<Piece>& pieces, scene::JointType type, const Vector3& axis) {
  scene::Entity entity =
      prototype("hung", at(0, 0, 10), false, {link("base", scene::Box{{0.02, 0.02, 0.02}}, 1)});
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    entity.links.push_back(pieces[i].link("piece" + std::to_string(i)));
    const Pose joint_frame = math::inverse(pieces[i].bottom());
    if (i == 0) {
      // The scene gives axes in the child's frame.
      entity.joints.push_back(join(type, 0, {}, 1, joint_frame, joint_frame.orientation * axis));
    } else {
      entity.joints.push_back(weld(i, math::inverse(pieces[i - 1].bottom()), i + 1, joint_frame));
    }
  }
  return entity;
}

TEST(Welded, TurnAccordingToTheirInertia) {
  // From rest, a motor's impulse L gives L / I.
  for (const Vector3& axis : {Vector3::UnitX().eval(), Vector3::UnitY().eval(),
                              Vector3::UnitZ().eval(), Vector3(1, -2, 0.5).normalized()}) {
    World world(empty_space(), 0.001);
    world.add(hung(crooked, scene::JointType::revolute, axis));
    const JointIndex hinge = world.joint(0, 0);
    const double impulse = 1e-4;  // [N m s]
    world.add_motor(hinge, scene::JointMode::velocity, impulse);
    world.set_target(hinge, 100);
    world.step();
    double inertia = 0;
    for (const Piece& piece : crooked) inertia += piece.inertia(axis);
    EXPECT_NEAR(world.velocity(hinge), impulse / inertia, 1e-9 * impulse / inertia)
        << axis.transpose();
  }
}

TEST(Welded, MoveAccordingToTheirMass) {
  World world(empty_space(), 0.001);
  world.add(hung(crooked, scene::JointType::prismatic, Vector3::UnitY()));
  const JointIndex rail = world.joint(0, 0);
  world.add_motor(rail, scene::JointMode::velocity, 1e-3);
  world.set_target(rail, 100);
  world.step();
  EXPECT_NEAR(world.velocity(rail), 1e-3 / 1.6, 1e-12);
}

TEST(Welded, SwingInTheirClosedFormPeriod) {
  // Two cubes on a rod, 0.3 m and 0.5 m below the axis.
  const double g = 9.8, h = 0.001, start = 0.05;
  const std::vector<Piece> dumbbell = {{at(0, 0, -0.3), {0.1, 0.1, 0.1}, 1},
                                       {at(0, 0, -0.25), {0.01, 0.01, 0.5}, 0.2},
                                       {at(0, 0, -0.5), {0.1, 0.1, 0.1}, 2}};
  World world(with_gravity(g), h);
  scene::Entity entity = hung(dumbbell, scene::JointType::revolute, Vector3::UnitY());
  entity.joints[0].parent_frame.orientation = about({0, 1, 0}, start);
  world.add(entity);
  const JointIndex axis = world.joint(0, 0);
  std::vector<double> crossings;
  double previous = start;
  for (int n = 1; crossings.size() < 5 && n < 20000; ++n) {
    world.step();
    const double angle = world.position(axis) + start;
    if (previous > 0 && angle <= 0) crossings.push_back(h * (n - angle / (angle - previous)));
    previous = angle;
  }
  double inertia = 0, moment = 0;
  for (const Piece& piece : dumbbell) {
    inertia += piece.inertia(Vector3::UnitY());
    moment += piece.mass * -piece.centre.position.z();
  }
  const double period = 2 * EIGEN_PI * std::sqrt(inertia / (g * moment)) * (1 + start * start / 16);
  ASSERT_EQ(crossings.size(), 5u);
  EXPECT_NEAR((crossings.back() - crossings.front()) / 4, period, 0.001 * period);
}

TEST(Welded, KeepTheirEnergyOnABallJoint) {
  // Tumbling about all axes for 5 s at 1 ms.
  World world(with_gravity(9.8), 0.001);
  scene::Entity entity = hung(crooked, scene::JointType::spherical, Vector3::UnitZ());
  entity.joints[0].parent_frame.orientation = about({1, 0.3, 0}, 1.2);
  world.add(entity);
  const double start = world.energy();
  const double range = 1.6 * 9.8 * 0.05;  // of the potential energy [J]
  for (int n = 0; n < 5000; ++n) {
    world.step();
    ASSERT_NEAR(world.energy(), start, 0.01 * range) << n;
  }
}

TEST(Welded, LinksMoveAsOneRigidBody) {
  const double h = 1e-4;
  World world(with_gravity(9.8), h);
  scene::Entity entity = hung(crooked, scene::JointType::spherical, Vector3::UnitZ());
  entity.joints[0].parent_frame.orientation = about({1, 0.3, 0}, 1.2);
  world.add(entity);
  const world::State start = state_of(world);
  for (int n = 0; n < 5000; ++n) world.step();
  const world::State before = state_of(world);
  world.step();
  const world::State after = state_of(world);
  EXPECT_GT(after.links[1].angular_velocity.norm(), 1);
  for (std::size_t i = 1; i < start.links.size(); ++i) {
    const Pose in_first = math::inverse(start.links[1].pose) * start.links[i].pose;
    const Pose expected = after.links[1].pose * in_first;
    const world::LinkState& link = after.links[i];
    EXPECT_LT((link.pose.position - expected.position).norm(), 1e-12);
    EXPECT_LT(link.pose.orientation.angularDistance(expected.orientation), 1e-7);
    EXPECT_EQ(link.angular_velocity, after.links[1].angular_velocity);
    const Vector3 arm = link.pose.position - after.links[1].pose.position;
    EXPECT_LT((link.velocity - after.links[1].velocity - link.angular_velocity.cross(arm)).norm(),
              1e-12);
    const Vector3 moved = (link.pose.position - before.links[i].pose.position) / h;
    EXPECT_LT((link.velocity - moved).norm(), 2e-3 * link.velocity.norm());
  }
}

TEST(Welded, LinksCarryJoints) {
  // A bracket welded to the world carries a rod on a ball joint.
  World world(with_gravity(9.8), 0.01);
  scene::Entity entity = prototype("arm", at(0, 0, 10), false,
                                   {link("base", scene::Box{{0.1, 0.1, 0.1}}, 1),
                                    link("bracket", scene::Box{{0.3, 0.02, 0.02}}, 0.2),
                                    link("rod", scene::Cylinder{0.01, 0.4}, 0.3)});
  entity.joints.push_back(weld(0, at(0.05, 0, 0.05), 1, at(-0.15, 0, 0.01)));
  entity.joints.push_back(
      join(scene::JointType::spherical, 1, {{0.15, 0, 0.01}, about({1, 0, 0}, 2)}, 2));
  world.add(entity);
  for (int n = 0; n < 500; ++n) world.step();
  const world::State state = state_of(world);
  EXPECT_LT((state.links[2].pose.position - Vector3(0.35, 0, 10.05)).norm(), 1e-9);
  EXPECT_GT(state.links[2].velocity.norm() + state.links[2].angular_velocity.norm(), 0.01);
  EXPECT_EQ(state.links[1].velocity, Vector3(0, 0, 0));
}

/// A table top on four legs welded to it; its frame is the top's.
scene::Entity table(const Pose& pose) {
  scene::Entity entity =
      prototype("table", pose, true, {link("top", scene::Box{{0.4, 0.3, 0.02}}, 0.5)});
  for (const double x : {-0.18, 0.18}) {
    for (const double y : {-0.13, 0.13}) {
      entity.links.push_back(link("leg", scene::Cylinder{0.01, 0.2}, 0.1));
      entity.joints.push_back(weld(0, at(x, y, 0), entity.links.size() - 1, at(0, 0, 0.2)));
    }
  }
  return entity;
}

TEST(Welded, ATableStandsOnItsLegs) {
  World world(with_floor(9.8), 0.005);
  world.add(table(at(0, 0, 0.21)));
  for (int n = 0; n < 400; ++n) world.step();
  const world::LinkState top = state_of(world).links[0];
  EXPECT_NEAR(top.pose.position.z(), 0.2, 1e-4);
  EXPECT_LT(top.velocity.norm(), 1e-4);
  EXPECT_LT(top.pose.orientation.angularDistance(Quaternion::Identity()), 1e-4);
}

TEST(Welded, StandWhereTheyWereMoved) {
  World world(with_floor(9.8), 0.005);
  world.add(table(at(0, 0, 0.21)));
  for (int n = 0; n < 20; ++n) world.step();
  const Pose target{{1, -2, 0.205}, about({0, 0, 1}, 0.3)};
  world.move(0, target);
  const world::State moved = state_of(world);
  for (const world::LinkState& link : moved.links) {
    EXPECT_LT(link.velocity.norm() + link.angular_velocity.norm(), 1e-12);
  }
  EXPECT_LT((moved.links[4].pose.position - target * Vector3(0.18, 0.13, -0.2)).norm(), 1e-12);
  for (int n = 0; n < 400; ++n) world.step();
  const Pose top = state_of(world).links[0].pose;
  EXPECT_LT((top.position - Vector3(1, -2, 0.2)).norm(), 1e-4);
  EXPECT_LT(top.orientation.angularDistance(target.orientation), 1e-3);
}

TEST(Welded, TipOverIfTheirCentreOfMassIsBeyondTheFoot) {
  // A 0.1 m foot of 1 kg with an arm of 0.5 kg, whose centre is `out` [m] in front of the foot's
  // centre.
  for (const double out : {0.14, 0.16}) {
    World world(with_floor(9.8), 0.005);
    scene::Entity entity = prototype("crane", at(0, 0, 0), true,
                                     {link("foot", scene::Box{{0.1, 0.1, 0.1}}, 1),
                                      link("arm", scene::Box{{0.2, 0.02, 0.02}}, 0.5)});
    entity.joints.push_back(weld(0, at(out, 0, 0.1), 1));
    world.add(entity);
    for (int n = 0; n < 600; ++n) world.step();
    const Vector3 up = state_of(world).links[0].pose.orientation * Vector3::UnitZ();
    EXPECT_EQ(up.z() < 0.95, out * 0.5 / 1.5 > 0.05) << out;
  }
}

TEST(Welded, AForkLiftsABox) {
  // The box lies on a fork that is welded to the carriage; it may sleep before the lift starts.
  World world(with_floor(9.8), 0.005);
  scene::Entity lift = prototype("lift", at(0, 0, 0), false,
                                 {link("mast", scene::Box{{0.05, 0.05, 0.5}}, 1),
                                  link("carriage", scene::Box{{0.02, 0.1, 0.1}}, 0.5),
                                  link("fork", scene::Box{{0.2, 0.15, 0.01}}, 0.2)});
  lift.joints.push_back(
      join(scene::JointType::prismatic, 0, at(0.04, 0, 0.1), 1, at(0, 0, 0), Vector3::UnitZ()));
  lift.joints.push_back(weld(1, at(0.11, 0, 0), 2));
  world.add(lift);
  world.add(
      single(scene::EntityKind::box, at(0.15, 0, 0.11), true, scene::Box{{0.05, 0.05, 0.05}}, 0.1));
  const JointIndex rail = world.joint(0, 0);
  world.add_motor(rail, scene::JointMode::position, 1);
  for (int n = 0; n < 300; ++n) world.step();
  EXPECT_NEAR(state_of(world).links[3].pose.position.z(), 0.11, 1e-4);
  world.set_target(rail, 0.2);
  for (int n = 0; n < 400; ++n) world.step();
  const world::State state = state_of(world);
  EXPECT_NEAR(state.links[2].pose.position.z(), 0.3, 1e-4);
  EXPECT_NEAR(state.links[3].pose.position.z(), 0.31, 1e-3);
}

TEST(Welded, AFixedShelfCarriesABox) {
  World world(with_gravity(9.8), 0.005);
  scene::Entity shelf = prototype(
      "shelf", at(0, 0, 1), false,
      {link("wall", scene::Box{{0.02, 1, 1}}, 0), link("board", scene::Box{{0.3, 1, 0.02}}, 1)});
  shelf.joints.push_back(weld(0, at(0.16, 0, 0.5), 1));
  world.add(shelf);
  world.add(
      single(scene::EntityKind::box, at(0.2, 0, 1.53), true, scene::Box{{0.1, 0.1, 0.1}}, 0.5));
  for (int n = 0; n < 400; ++n) world.step();
  const world::State state = state_of(world);
  EXPECT_EQ(state.links[1].pose.position, Vector3(0.16, 0, 1.5));
  EXPECT_NEAR(state.links[2].pose.position.z(), 1.52, 1e-4);
}

/// A fixed magnet, and a free bar with a magnet at its end.
scene::Physics magnetic() {
  scene::Physics physics = empty_space();
  physics.magnetism = scene::Magnetism{};
  return physics;
}

Pose after_pull(const scene::Entity& bar, int link) {
  World world(magnetic(), 0.001);
  scene::Entity pole = prototype("pole", at(0.3, 0.25, 0.4), false,
                                 {testing::link("base", scene::Sphere{0.003}, 0.001)});
  pole.devices.magnets.push_back(magnet(0, {0, 0, 0.003}, {1000, 2000, -1500}));
  world.add(pole);
  world.add(bar);
  for (int n = 0; n < 300; ++n) world.step();
  const world::LinkState state = state_of(world).links[static_cast<std::size_t>(link) + 1];
  EXPECT_GT(state.angular_velocity.norm(), 0.5);
  return state.pose;
}

TEST(Welded, AMagnetMovesTheWholeLikeOnePiece) {
  const Pose pose{{0.1, 0.2, 0.3}, about({1, 1, 0}, 0.3)};
  const Vector3 field(1500, -700, 900);
  scene::Entity whole =
      prototype("bar", pose, true, {link("bar", scene::Box{{0.4, 0.03, 0.02}}, 0.2)});
  whole.devices.magnets.push_back(magnet(0, {0.2, 0.01, 0}, field));
  // Halves; the second, with the magnet, lies on its side, so it is 0.02 m wide and 0.03 m high.
  const Quaternion side = about({1, 0, 0}, EIGEN_PI / 2);
  scene::Entity halves = prototype("bar", pose * at(-0.1, 0, 0), true,
                                   {link("a", scene::Box{{0.2, 0.03, 0.02}}, 0.1),
                                    link("b", scene::Box{{0.2, 0.02, 0.03}}, 0.1)});
  const Pose other = Pose{{0.2, 0.015, 0.01}, side};  // b's frame in a's
  halves.joints.push_back(weld(0, other, 1));
  const Pose from_whole = math::inverse(at(-0.1, 0, 0) * other);
  halves.devices.magnets.push_back(
      magnet(1, from_whole * Vector3(0.2, 0.01, 0), from_whole.orientation * field));
  const Pose one = after_pull(whole, 0) * at(-0.1, 0, 0), two = after_pull(halves, 0);
  EXPECT_LT((one.position - two.position).norm(), 1e-9);
  EXPECT_LT(one.orientation.angularDistance(two.orientation), 1e-6);
}

TEST(Welded, AreDampedByTheDialectsLaw) {
  // Both links have 0.04, or one has 0.06 and its mirror image 0.02.
  for (const double difference : {0.0, 0.02}) {
    const double g = 9.8, h = 0.01;
    World world(with_gravity(g), h);
    scene::Entity entity = prototype("body", at(0, 0, 10), true,
                                     {link("left", scene::Box{{0.1, 0.1, 0.1}}, 1, at(-0.05, 0, 0)),
                                      link("right", scene::Box{{0.1, 0.1, 0.1}}, 1)});
    entity.links[0].damping = {0.04 + difference, 0.04};
    entity.links[1].damping = {0.04 - difference, 0.04};
    entity.joints.push_back(weld(0, at(0.1, 0, 0), 1));
    world.add(entity);
    double velocity = 0;
    for (int n = 0; n < 5; ++n) {
      velocity -= h * (g + 0.04 * velocity * (1 + std::abs(velocity)));
      world.step();
    }
    const world::State state = state_of(world);
    const Vector3 middle = (state.links[0].velocity + state.links[1].velocity) / 2;
    EXPECT_NEAR(middle.z(), velocity, difference == 0 ? 1e-6 : 1e-5) << difference;
    // The left one falls more slowly.
    const double turning = state.links[0].angular_velocity.y();
    EXPECT_EQ(turning > 1e-4, difference > 0) << turning;
  }
}

TEST(Welded, AreHitByRaysAtTheirPoses) {
  scene::Physics physics = with_gravity(9.8);
  World world(physics, 0.01);
  Rays rays(physics);
  const scene::Entity entity = table(at(0, 0, 5));
  world.add(entity);
  rays.add(entity);
  for (int n = 0; n < 10; ++n) world.step();
  const world::State state = state_of(world);
  rays.update(state);
  const double bottom = state.links[0].pose.position.z() - 0.2;
  EXPECT_NEAR(bottom, 4.8 - fall(9.8, 0.01, 10), 1e-9);
  // A horizontal ray below the top through two legs: it hits the first one.
  const auto hit = rays.cast({.start = {1, 0.13, bottom + 0.001},
                              .end = {-1, 0.13, bottom + 0.001},
                              .ignored = {},
                              .sees_floor = false});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->entity, 0u);
  EXPECT_NEAR(hit->distance, 1 - 0.19, 1e-9);
}

}  // namespace
}  // namespace ziggurat::physics
