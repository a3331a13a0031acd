// The substep of the drop scene (n/2 boxes and n/2 cylinders of 1 cm, 0.25 kg, at the areal density
// of dynamics3d_single_body_test, 10 ms substeps) in two worlds, interleaved round by round:
//
//   ours   physics::World, its state read once per tick of 20 substeps
//   raw    bare Bullet in raw metres with its default margins and 10 iterations, box floor of 1 cm
//
// Thread CPU time. usage: bench_drop [rounds]

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
#include <cstdlib>
#include <functional>
#include <random>
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

double cpu_seconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Microseconds per substep over the fall, the settling and the whole 8 s.
struct Times {
  double fall, settle, all;
};

Times time_run(const std::function<void(int)>& tick) {
  double mark[4] = {cpu_seconds()};
  for (int n = 0; n < 40; ++n) {  // ticks of 0.2 s
    tick(n);
    if (n == 2) mark[1] = cpu_seconds();
    if (n == 9) mark[2] = cpu_seconds();
  }
  mark[3] = cpu_seconds();
  return {(mark[1] - mark[0]) / (3 * per_tick) * 1e6, (mark[2] - mark[1]) / (7 * per_tick) * 1e6,
          (mark[3] - mark[0]) / (40 * per_tick) * 1e6};
}

Times ours(const std::vector<Placed>& placed) {
  scene::Physics settings;
  settings.floor = scene::Floor{};
  settings.gravity = 9.8;
  physics::World world(settings, substep);
  for (const Placed& each : placed) {
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
  return time_run([&](int) {
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

Times raw(const std::vector<Placed>& placed) {
  BareBodies bare;
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btMultiBodyConstraintSolver solver;
  btMultiBodyDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity(btVector3(0, 0, -9.8));
  btTransform floor(btQuaternion::getIdentity(), btVector3(0, 0, -0.005));
  world.addRigidBody(&bare.add(std::make_unique<btBoxShape>(btVector3(2, 2, 0.005)), 0, floor));
  for (const Placed& each : placed) {
    world.addRigidBody(&bare.add(bullet_shape(each), each.mass, centre(each)));
  }
  const Times times = time_run([&](int) {
    for (int i = 0; i < per_tick; ++i) world.stepSimulation(substep, 0);
  });
  for (auto& body : bare.bodies) world.removeRigidBody(body.get());
  return times;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void compare(int count, int rounds) {
  const std::vector<Placed> placed = drop_scene(count);
  std::vector<Times> own, bare;
  for (int round = 0; round < rounds; ++round) {
    own.push_back(ours(placed));
    bare.push_back(raw(placed));
  }
  const auto row = [&](const char* phase, double Times::*part) {
    std::vector<double> us, faster;
    for (int i = 0; i < rounds; ++i) {
      us.push_back(own[i].*part);
      faster.push_back(bare[i].*part / (own[i].*part));
    }
    fmt::print("| {} | {} | {:.0f} | {:.2f} |\n", count, phase, median(us), median(faster));
  };
  row("fall, 0-0.6 s", &Times::fall);
  row("settling, 0.6-2 s", &Times::settle);
  row("whole, 0-8 s", &Times::all);
}

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 7;
  fmt::print("| bodies | phase | us per substep | raw Bullet / ours |\n|---|---|---|---|\n");
  for (const int count : {100, 400, 1600})
    compare(count, count > 1000 ? std::max(1, rounds / 2) : rounds);
}
