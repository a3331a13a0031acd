// Boxes and cubes of about 1 cm that fall at random into a bin, in substeps of 10 ms. Printed per
// phase: thread CPU time per substep, the worst overlap after a substep, and how often the contact
// law was missed. The heap is at rest when no body has moved by more than 1 um in a substep for 0.5
// s.
//
// usage: bench_pile [BODIES [SECONDS [HZ]]]    default: 100, 400, 1 000 bodies, 6 s, 100 Hz

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include "physics/bodies/convert.h"
#include "physics/collision/shapes.h"
#include "physics/world.h"

namespace {

using namespace ziggurat;
using math::Pose, math::Vector3;

double cpu_seconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

scene::Entity box(const Pose& pose, const Vector3& size, double mass) {
  scene::Entity entity;
  entity.kind = scene::EntityKind::box;
  entity.movable = mass > 0;
  entity.pose = pose;
  scene::Link link;
  link.geometry = scene::Box{size};
  link.mass = mass;
  link.surface.friction = 0.7;
  entity.links.push_back(link);
  return entity;
}

/// Four walls, then the bodies: every second one a cube of 1 cm, the others with edges of 6 to 14
/// mm.
std::vector<scene::Entity> pile_scene(int count) {
  const int across = std::max(3, static_cast<int>(std::lround(std::cbrt(count / 2.0))));
  const double wall = across * 0.0075 + 0.004, height = 0.015 * (count / across / across + 2);
  std::vector<scene::Entity> made;
  for (const double sign : {-1.0, 1.0}) {
    const double away = sign * (wall + 0.05);
    made.push_back(
        box({{away, 0, 0}, math::Quaternion::Identity()}, {0.1, 2 * wall + 0.4, height}, 0));
    made.push_back(box({{0, away, 0}, math::Quaternion::Identity()}, {2 * wall, 0.1, height}, 0));
  }
  std::mt19937 random(1);
  const auto draw = [&] { return random() / 2147483647.5 - 1; };
  for (int i = 0; i < count; ++i) {
    const int layer = i / (across * across), x = i % across, y = i / across % across;
    double drawn[9];
    for (double& value : drawn) value = draw();
    Vector3 size(0.01, 0.01, 0.01);
    for (int k = 0; k < 3 && i % 2; ++k) size[k] += 0.004 * drawn[6 + k];
    Pose pose{{0.015 * (x - (across - 1) / 2.0) + 0.001 * drawn[0],
               0.015 * (y - (across - 1) / 2.0) + 0.001 * drawn[1], 0.015 * (layer + 1)},
              math::Quaternion(drawn[2], drawn[3], drawn[4], drawn[5]).normalized()};
    made.push_back(box(pose, size, 1000 * size.prod()));
  }
  return made;
}

/// A world, and what is measured of it.
struct Run {
  physics::World world;
  const std::vector<scene::Entity>& entities;
  world::State state;
  std::vector<Vector3> before;
  double seconds = 0, longest = 0, still = 0, at_rest = -1;
  double overlap = 0, moved = 0;
  std::size_t islands_missed = 0, missed_before = 0, steps = 0;

  Run(const scene::Physics& physics, const std::vector<scene::Entity>& scene, double substep)
      : world(physics, substep), entities(scene) {
    for (const scene::Entity& entity : scene) world.add(entity);
  }
  void step(double substep, double now);
  double deepest() const;
};

btTransform centre(const scene::Entity& entity, const Pose& origin) {
  const Vector3& size = std::get<scene::Box>(entity.links[0].geometry).size;
  return physics::to_bullet(origin * Pose{{0, 0, size.z() / 2}, math::Quaternion::Identity()});
}

/// The worst overlap of any two bodies now [m].
double Run::deepest() const {
  struct Placed {
    double low, high, radius;
    btTransform pose;
    physics::contact::Box shape;
    bool moves;
  };
  std::vector<Placed> placed;
  double worst = 0;
  for (std::size_t i = 0; i < entities.size(); ++i) {
    const Vector3 half = std::get<scene::Box>(entities[i].links[0].geometry).size / 2;
    const btTransform pose = centre(entities[i], state.origins[i]);
    const double radius = half.norm(), x = pose.getOrigin().x();
    placed.push_back(
        {x - radius, x + radius, radius, pose, {physics::to_bullet(half)}, entities[i].movable});
    if (!entities[i].movable) continue;
    const btVector3 up = pose.getBasis().getRow(2).absolute();
    worst = std::max(worst, double(up.dot(placed.back().shape.half) - pose.getOrigin().z()));
  }
  std::sort(placed.begin(), placed.end(),
            [](const Placed& a, const Placed& b) { return a.low < b.low; });
  for (std::size_t i = 0; i < placed.size(); ++i) {
    for (std::size_t j = i + 1; j < placed.size() && placed[j].low < placed[i].high; ++j) {
      const Placed &a = placed[i], &b = placed[j];
      const double near = a.radius + b.radius;
      if (!(a.moves || b.moves)) continue;
      if ((a.pose.getOrigin() - b.pose.getOrigin()).length2() > near * near) continue;
      const auto found = physics::contact::find(a.shape, a.pose, b.shape, b.pose, 0);
      for (int k = 0; k < found.count; ++k) {
        worst = std::max(worst, -double(found.points[k].distance));
      }
    }
  }
  return worst;
}

void Run::step(double substep, double now) {
  const double start = cpu_seconds();
  world.step();
  const double time = cpu_seconds() - start;
  seconds += time;
  longest = std::max(longest, time);
  ++steps;
  world.read(state);
  overlap = std::max(overlap, deepest());
  moved = 0;
  for (std::size_t i = 0; i < state.origins.size() && !before.empty(); ++i) {
    moved = std::max(moved, (state.origins[i].position - before[i]).norm());
  }
  const bool rests = !before.empty() && moved < 1e-6;
  still = rests ? still + substep : 0;
  if (!rests) at_rest = -1;
  if (still >= 0.5 && at_rest < 0) at_rest = now - still;
  before.resize(state.origins.size());
  for (std::size_t i = 0; i < before.size(); ++i) before[i] = state.origins[i].position;
}

void measure(int count, double seconds, double hz) {
  const std::vector<scene::Entity> entities = pile_scene(count);
  scene::Physics settings;
  settings.floor = scene::Floor{};
  settings.gravity = 9.8;
  Run run(settings, entities, 1 / hz);
  const int steps = static_cast<int>(std::lround(seconds * hz));
  const int phase = std::max(1, steps / 6);
  for (int n = 0; n < steps; ++n) {
    run.step(1 / hz, (n + 1) / hz);
    if (n % phase != phase - 1) continue;
    const physics::Convergence told = run.world.convergence();
    fmt::print("| {} | {:.1f} s | {:.2f} | {:.1f} | {:.2f} | {:.2g} | {} | {:.1e} |\n", count,
               (n + 1) / hz, 1e3 * run.seconds / double(run.steps), 1e3 * run.longest,
               1e3 * run.overlap, 1e3 * run.moved * hz, told.not_converged - run.missed_before,
               told.worst);
    std::fflush(stdout);
    run.missed_before = told.not_converged;
    run.seconds = run.longest = run.overlap = 0;
    run.steps = 0;
  }
  fmt::print("| {} | at rest | {:.2f} s (-1: never) |\n", count, run.at_rest);
}

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc > 2 ? std::atof(argv[2]) : 6,
               hz = argc > 3 ? std::atof(argv[3]) : 100;
  fmt::print(
      "| bodies | until | ms per substep | longest | overlap, mm | fastest now, mm/s | islands "
      "that "
      "missed | worst miss so far |\n|---|---|---|---|---|---|---|---|\n");
  if (argc > 1) return measure(std::atoi(argv[1]), seconds, hz), 0;
  for (const int count : {100, 400, 1000}) measure(count, seconds, hz);
}
