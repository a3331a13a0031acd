// SPDX-License-Identifier: MIT
// Contact events of plug-ins, and sensing of watched links.

#include "physics/contact_sensing.h"

#include <gtest/gtest.h>

#include <string>

#include "bench_scene.h"
#include "physics/core.h"
#include "physics/plugins.h"

namespace ziggurat::physics {
namespace {

using namespace testing;
using math::Vector3;

constexpr double g = 9.8, h = 0.01;

scene::Entity box(const math::Pose& pose, double mass = 1) {
  return single(scene::EntityKind::box, pose, true, scene::Box{{0.1, 0.1, 0.1}}, mass);
}

/// Writes down what it is told.
class Log final : public Plugin {
 public:
  explicit Log(std::string& text) : text_(text) {}
  bool wants_contacts(std::span<const Body>) const override { return true; }
  void before_substep(std::span<Body>, double) override { text_ += '<'; }
  void contact_begins(std::span<Body>, const LinkContact& contact) override { add('b', contact); }
  void contact_persists(std::span<Body>, const LinkContact& contact) override { add('p', contact); }
  void contact_ends(std::span<Body>, const LinkContact& contact) override { add('e', contact); }
  void after_substep(std::span<Body>, double) override { text_ += '>'; }

 private:
  void add(char what, const LinkContact& contact) {
    text_ += what + std::to_string(contact.a.entity) +
             (contact.b.entity == ContactSide::floor ? "f" : std::to_string(contact.b.entity));
  }
  std::string& text_;
};

/// Bodies, a core and one plug-in that logs.
struct Bench {
  std::string log;
  std::vector<Body> bodies;
  NewtonCore core;
  Plugins plugins;

  explicit Bench(const scene::Physics& physics) : core(physics), plugins(physics, core) {
    plugins.add(std::make_unique<Log>(log));
  }
  ~Bench() {
    for (Body& body : bodies) core.remove(body);
  }
  void add(const scene::Entity& entity) {
    bodies.push_back(core.add(entity, bodies.size()));
    plugins.add(bodies.back());
  }
  std::string step() {
    log.clear();
    plugins.before_substep(bodies, h);
    core.substep(bodies, h, 1, plugins.stiff());
    plugins.after_substep(bodies, h, core);
    return log;
  }
};

TEST(Contacts, BeginPersistAndEnd) {
  Bench bench(with_floor(g));
  bench.add(box(at(0, 0, 0)));
  bench.add(box(at(0, 0, 0.1)));
  EXPECT_EQ(bench.step(), "<b01b0f>");
  EXPECT_EQ(bench.step(), "<p01p0f>");
  bench.bodies[1].placed = at(2, 0, 3);
  bench.bodies[1].links[0].placed = at(2, 0, 3);
  bench.core.move(bench.bodies[1]);
  EXPECT_EQ(bench.step(), "<p0fe01>");
  EXPECT_EQ(bench.step(), "<p0f>");
}

TEST(Contacts, OfWhatIsNotReachedYetAreNone) {
  Bench bench(with_floor(g));
  bench.add(box(at(0, 0, 0.002)));  // within reach of the contact geometry, but not touching
  EXPECT_EQ(bench.step(), "<>");
}

TEST(ContactSensing, ABoxAtRestCarriesItsWeight) {
  for (const bool rigid : {true, false}) {  // as Bullet's rigid body, and as its multi-body
    scene::Physics physics = with_floor(g);
    World world(physics, h);
    scene::Entity entity = box(at(0, 0, 0), 2);
    if (!rigid) {
      entity.kind = scene::EntityKind::prototype;
      entity.devices.magnets = {magnet(0, {0, 0, 0}, {0, 0, 0})};
    }
    world.add(entity);
    world.watch_contacts(0, 0);
    EXPECT_FALSE(world.take_touch(0, 0).touched);
    for (int i = 0; i < 50; ++i) world.step();
    world.take_touch(0, 0);
    for (int i = 0; i < 10; ++i) world.step();
    const LinkTouch touch = world.take_touch(0, 0);
    EXPECT_TRUE(touch.touched);
    EXPECT_NEAR(touch.impulse.z() / (10 * h), 2 * g, 0.01 * 2 * g) << rigid;
    EXPECT_NEAR(touch.impulse.head<2>().norm(), 0, 1e-3);
    EXPECT_NEAR(touch.magnitude, touch.impulse.norm(), 1e-3);
    EXPECT_FALSE(world.take_touch(0, 0).touched) << "asked twice";
  }
}

TEST(ContactSensing, OfASleepingBoxIsStillItsWeight) {
  World world(with_floor(g), h);
  world.add(box(at(0, 0, 0)));
  world.watch_contacts(0, 0);
  for (int i = 0; i < 300; ++i) world.step();
  EXPECT_EQ(state_of(world).links[0].velocity, Vector3(0, 0, 0));
  world.take_touch(0, 0);
  world.step();
  EXPECT_NEAR(world.take_touch(0, 0).impulse.z() / h, g, 0.05 * g);
}

TEST(ContactSensing, ASqueezedLinkFeelsBothSides) {
  World world(with_floor(g), h);
  world.add(box(at(0, 0, 0), 1));
  world.add(box(at(0, 0, 0.1), 3));
  world.watch_contacts(0, 0);
  for (int i = 0; i < 100; ++i) world.step();
  world.take_touch(0, 0);
  for (int i = 0; i < 10; ++i) world.step();
  const LinkTouch touch = world.take_touch(0, 0);
  EXPECT_NEAR(touch.impulse.z() / (10 * h), g, 0.05 * g);  // 4 g up, 3 g down
  EXPECT_NEAR(touch.magnitude / (10 * h), 7 * g, 0.05 * 7 * g);
}

TEST(ContactSensing, FrictionHoldsABoxOnASlope) {
  World world(with_gravity(g), h);
  const math::Quaternion tilt = about({0, 1, 0}, 0.1);
  world.add(
      single(scene::EntityKind::box, {{0, 0, -0.1}, tilt}, false, scene::Box{{2, 1, 0.1}}, 0));
  scene::Entity entity = box({Vector3(0, 0, -0.1) + tilt * Vector3(0, 0, 0.1), tilt});
  world.add(entity);
  world.watch_contacts(1, 0);
  for (int i = 0; i < 30; ++i) world.step();
  world.take_touch(1, 0);
  for (int i = 0; i < 10; ++i) world.step();
  const Vector3 force = world.take_touch(1, 0).impulse / (10 * h);
  EXPECT_NEAR((force - Vector3(0, 0, g)).norm(), 0, 0.03 * g) << force.transpose();
}

TEST(ContactList, HasEveryContactWithItsForce) {
  World world(with_floor(g), h);
  world.add(box(at(0, 0, 0), 1));
  world.add(box(at(0, 0, 0.1), 3));
  std::vector<world::Contact> contacts;
  for (int i = 0; i < 100; ++i) world.step();
  world.list_contacts(contacts);
  ASSERT_EQ(contacts.size(), 2u);
  EXPECT_EQ(contacts[0].link, 0u);
  EXPECT_EQ(contacts[0].other, 1u);
  EXPECT_NEAR(contacts[0].normal.z(), -1, 1e-6) << "from the upper box down to the lower one";
  EXPECT_NEAR(contacts[0].force.z(), -3 * g, 0.05 * 3 * g);
  EXPECT_NEAR(contacts[0].point.z(), 0.1, 0.002);
  EXPECT_EQ(contacts[1].link, 0u);
  EXPECT_FALSE(contacts[1].other) << "the floor";
  EXPECT_NEAR(contacts[1].force.z(), 4 * g, 0.05 * 4 * g);
  EXPECT_NEAR(contacts[1].point.z(), 0, 0.002);
}

TEST(ContactSensing, OfARemovedEntityIsNone) {
  World world(with_floor(g), h);
  world.add(box(at(0, 0, 0)));
  world.watch_contacts(0, 0);
  world.step();
  world.remove(0);
  world.step();
  EXPECT_FALSE(world.take_touch(0, 0).touched);
}

}  // namespace
}  // namespace ziggurat::physics
