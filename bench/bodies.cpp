// SPDX-License-Identifier: MIT
// Substeps of bodies that fall, in one of two worlds:
//
//   ours     physics::World, its state read once per tick of 20 substeps
//   bullet   bare Bullet in raw metres with its default margins and 10 iterations, box floor
//
// usage: bench_bodies SCENE COUNT (ours | bullet)
//
// SCENE is one of
//
//   fall    the first 0.6 s of the drop scene: n/2 boxes and n/2 cylinders of 1 cm, 0.25 kg, at the
//           areal density of dynamics3d_single_body_test
//   whole   8 s of it
//   pile    the first second of n boxes of 10 cm, 1 kg, dropped in layers into a bin
//
// Substeps of 10 ms. Prints microseconds of the thread's CPU time per substep.

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "physics/bodies/convert.h"
#include "physics/world.h"

namespace {

using namespace ziggurat;

constexpr double substep = 0.01;
constexpr int per_tick = 20;

struct Placed {
  scene::Geometry geometry;
  math::Pose pose;  // of the bottom centre
  double mass;      // 0 = static
};

math::Pose standing(double x, double y) { return {{x, y, 0}, math::Quaternion::Identity()}; }

/// Walls first, then the bodies, apart from each other by at least 18 mm.
std::vector<Placed> drop_scene(int count) {
  const double scale = std::sqrt(count / 100.0), side = 0.5 * scale, half = side / 2;
  const double wall = side - 0.025, spread = 0.2 * scale;
  std::vector<Placed> placed;
  for (const double sign : {1.0, -1.0}) {
    placed.push_back(
        {scene::Box{{0.025, wall, 0.025}}, standing(sign * (half - 0.0125), sign * 0.0125), 0});
    placed.push_back(
        {scene::Box{{wall, 0.025, 0.025}}, standing(sign * 0.0125, -sign * (half - 0.0125)), 0});
  }
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<math::Vector3> taken;
  while (static_cast<int>(taken.size()) < count) {
    const math::Vector3 at(spread * uniform(engine), spread * uniform(engine),
                           0.15 + 0.1 * uniform(engine));
    const bool free = std::none_of(taken.begin(), taken.end(), [&](const math::Vector3& other) {
      return (other - at).norm() < 0.018;
    });
    if (!free) continue;
    math::Quaternion turn(uniform(engine), uniform(engine), uniform(engine), uniform(engine));
    turn.normalize();
    const bool box = static_cast<int>(taken.size()) < count / 2;
    taken.push_back(at);
    placed.push_back({box ? scene::Geometry(scene::Box{{0.01, 0.01, 0.01}})
                          : scene::Geometry(scene::Cylinder{0.005, 0.01}),
                      {at, turn},
                      0.25});
  }
  return placed;
}

/// Walls of a bin, then boxes in layers, turned at random.
std::vector<Placed> pile_scene(int count) {
  constexpr double side = 0.1, pitch = 0.15;
  const int across = std::max(3, static_cast<int>(std::lround(std::cbrt(count / 2.0))));
  const double inner = across * pitch, height = 0.15 * count / across / across + 0.5;
  std::vector<Placed> placed;
  for (const double sign : {1.0, -1.0}) {
    const double middle = sign * (inner / 2 + 0.1);
    placed.push_back({scene::Box{{0.2, inner, height}}, standing(middle, 0), 0});
    placed.push_back({scene::Box{{inner + 0.4, 0.2, height}}, standing(0, middle), 0});
  }
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < count; ++i) {
    const math::Vector3 at(pitch * (i % across - (across - 1) / 2.0),
                           pitch * (i / across % across - (across - 1) / 2.0),
                           pitch * (i / (across * across) + 1));
    math::Quaternion turn(uniform(engine), uniform(engine), uniform(engine), uniform(engine));
    turn.normalize();
    const math::Vector3 bottom = at - turn * math::Vector3(0, 0, side / 2);
    placed.push_back({scene::Box{{side, side, side}}, {bottom, turn}, 1});
  }
  return placed;
}

double cpu_seconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// A scene, and for how long it is measured.
struct Experiment {
  std::vector<Placed> placed;
  int ticks = 0;  // of 0.2 s
};

/// Microseconds per substep.
double time_run(const Experiment& experiment, const std::function<void()>& tick) {
  const double begin = cpu_seconds();
  for (int n = 0; n < experiment.ticks; ++n) tick();
  return (cpu_seconds() - begin) / (experiment.ticks * per_tick) * 1e6;
}

double ours(const Experiment& experiment) {
  scene::Physics settings;
  settings.floor = scene::Floor{};
  settings.gravity = 9.8;
  physics::World world(settings, substep);
  for (const Placed& each : experiment.placed) {
    scene::Entity entity;
    entity.kind = scene::EntityKind::box;
    entity.movable = each.mass > 0;
    entity.pose = each.pose;
    scene::Link link;
    link.geometry = each.geometry;
    link.mass = each.mass;
    link.surface.rolling_friction = 2e-4;
    entity.links.push_back(link);
    world.add(entity);
  }
  world::State state;
  return time_run(experiment, [&] {
    for (int i = 0; i < per_tick; ++i) world.step();
    world.read(state);
  });
}

/// Shapes and bodies of a bare Bullet world.
struct BareBodies {
  std::vector<std::unique_ptr<btCollisionShape>> shapes;
  std::vector<std::unique_ptr<btRigidBody>> bodies;

  btRigidBody& add(std::unique_ptr<btCollisionShape> shape, double mass, const btTransform& pose) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape.get(), inertia);
    info.m_startWorldTransform = pose;
    bodies.push_back(std::make_unique<btRigidBody>(info));
    bodies.back()->setFriction(0.5);
    shapes.push_back(std::move(shape));
    return *bodies.back();
  }
};

std::unique_ptr<btCollisionShape> bullet_shape(const Placed& placed) {
  if (const auto* box = std::get_if<scene::Box>(&placed.geometry)) {
    return std::make_unique<btBoxShape>(physics::to_bullet(math::Vector3(box->size / 2)));
  }
  const auto& can = std::get<scene::Cylinder>(placed.geometry);
  return std::make_unique<btCylinderShapeZ>(btVector3(can.radius, can.radius, can.height / 2));
}

btTransform centre(const Placed& placed) {
  const double up = std::holds_alternative<scene::Box>(placed.geometry)
                        ? std::get<scene::Box>(placed.geometry).size.z() / 2
                        : std::get<scene::Cylinder>(placed.geometry).height / 2;
  return physics::to_bullet(placed.pose * math::Pose{{0, 0, up}, math::Quaternion::Identity()});
}

double bullet(const Experiment& experiment) {
  BareBodies bare;
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btMultiBodyConstraintSolver solver;
  btMultiBodyDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity(btVector3(0, 0, -9.8));
  btTransform floor(btQuaternion::getIdentity(), btVector3(0, 0, -0.005));
  world.addRigidBody(&bare.add(std::make_unique<btBoxShape>(btVector3(2, 2, 0.005)), 0, floor));
  for (const Placed& each : experiment.placed) {
    world.addRigidBody(&bare.add(bullet_shape(each), each.mass, centre(each)));
  }
  const double time = time_run(experiment, [&] {
    for (int i = 0; i < per_tick; ++i) world.stepSimulation(substep, 0);
  });
  for (auto& body : bare.bodies) world.removeRigidBody(body.get());
  return time;
}

Experiment experiment_of(std::string_view scene, int count) {
  if (scene == "fall") return {drop_scene(count), 3};
  if (scene == "whole") return {drop_scene(count), 40};
  if (scene == "pile") return {pile_scene(count), 5};
  throw std::invalid_argument("SCENE is fall, whole or pile");
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 4) throw std::invalid_argument("write bench_bodies SCENE COUNT (ours | bullet)");
  const Experiment experiment = experiment_of(argv[1], std::stoi(argv[2]));
  const std::string_view world = argv[3];
  if (world != "ours" && world != "bullet") throw std::invalid_argument("write ours or bullet");
  fmt::print("{:.3f}\n", world == "ours" ? ours(experiment) : bullet(experiment));
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "bench_bodies: {}\n", error.what());
  return 1;
}
