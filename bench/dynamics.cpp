// SPDX-License-Identifier: MIT
// Cost of a substep of the equations of motion and the contact solver, without collision
// detection: two-wheeled robots that drive, boxes at rest, towers.
//
// usage: bench_dynamics          prints microseconds of CPU time per substep
//        bench_dynamics robots N
//        bench_dynamics CUBES [SUBSTEPS [HZ [verbose]]]    a pile

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string_view>
#include <vector>

#include "physics/stepping/system.h"
#include "pile.h"

namespace {

using namespace ziggurat::dynamics;

double cpu_seconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

constexpr double radius = 0.03, width = 0.02, track = 0.12;  // of the wheels [m]
using testing::g;

Link solid(double mass, const Vector3& inertia) {
  Link link;
  link.mass = mass;
  link.inertia = inertia;
  return link;
}

Tree robot(double x, double y) {
  std::vector<Link> links{solid(1, Vector3(2e-3, 2e-3, 3e-3))};
  for (const double side : {-1.0, 1.0}) {
    Link wheel = solid(0.05, Vector3(1.4e-5, 2.3e-5, 1.4e-5));
    wheel.parent = 0;
    wheel.joint = JointType::revolute;
    wheel.axis = Vector3::UnitY();
    wheel.joint_in_parent.position = Vector3(0, side * track / 2, -0.02);
    links.push_back(wheel);
  }
  Tree tree(links, {Vector3(x, y, radius + 0.02), Quaternion::Identity()});
  tree.gravity = Vector3(0, 0, -g);
  return tree;
}

/// Contacts of a robot with the floor: two of each wheel's edge and one of each of two casters.
void touch_floor(const Tree& tree, int index, std::vector<ContactPoint>& out) {
  const auto add = [&](int link, const Vector3& point, double mu) {
    ContactPoint contact;
    contact.a = {index, link};
    contact.point = Vector3(point.x(), point.y(), 0);
    contact.gap = point.z();
    contact.friction = mu;
    out.push_back(contact);
  };
  for (const int wheel : {1, 2}) {
    const Vector3 axis = tree.rotation[wheel].col(1);
    Vector3 down = axis * axis.z() - Vector3::UnitZ();
    down *= radius / down.norm();
    for (const double side : {-1.0, 1.0}) {
      add(wheel, tree.position[wheel] + axis * (side * width / 2) + down, 0.8);
    }
  }
  for (const double side : {-1.0, 1.0}) {
    add(0, tree.position[0] + tree.rotation[0] * Vector3(side * 0.05, 0, -0.02 - radius), 0.1);
  }
}

void remember(std::vector<ContactPoint>& now, const std::vector<ContactPoint>& before) {
  for (std::size_t i = 0; i < now.size() && now.size() == before.size(); ++i) {
    now[i].impulse = before[i].impulse;
    now[i].carried = !before[i].impulse.isZero(0);
  }
}

void bench_robots(int count) {
  System system;
  std::vector<Servo> servos;
  for (int i = 0; i < count; ++i) {
    system.trees.push_back(robot(0.3 * (i % 32), 0.3 * (i / 32)));
    for (int wheel = 0; wheel < 2; ++wheel) {
      Servo servo;
      servo.tree = i, servo.dof = 6 + wheel;
      servo.target_velocity = 3 + wheel + 0.1 * (i % 7);
      servo.lower = -1e-3, servo.upper = 1e-3;
      servos.push_back(servo);
    }
  }
  std::vector<ContactPoint> contacts, before;
  double total = 0;
  const int steps = 20000 / count + 200;
  Report worst;
  long iterations = 0;
  for (int i = 0; i < steps; ++i) {
    before.swap(contacts);
    contacts.clear();
    for (int r = 0; r < count; ++r) touch_floor(system.trees[r], r, contacts);
    remember(contacts, before);
    const double start = cpu_seconds();
    const Report report = system.step(0.01, contacts, servos);
    total += cpu_seconds() - start;
    iterations += report.most_iterations;
    worst.not_converged += report.not_converged;
  }
  std::printf("%5d robots: %.2f us per robot and substep, %.1f iterations, %d not converged\n",
              count, 1e6 * total / steps / count, double(iterations) / steps, worst.not_converged);
}

/// Towers that stand; contacts of sleepers are not told, as collision detection would not find
/// them.
void bench_boxes(int count, int height, bool sleeps) {
  System system;
  system.sleeping.enabled = sleeps;
  const double side = 0.05, mass = 0.1;
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < height; ++k) {
      Tree tree({solid(mass, Vector3::Constant(mass * side * side / 6))},
                {Vector3(0.2 * i, 0, side * (k + 0.5)), Quaternion::Identity()});
      tree.gravity = Vector3(0, 0, -g);
      system.trees.push_back(tree);
    }
  }
  std::vector<ContactPoint> contacts, before;
  double total = 0;
  const int steps = 20000 / (count * height) + 100;
  for (int i = 0; i < steps; ++i) {
    before.swap(contacts);
    contacts.clear();
    for (int t = 0; t < count * height; ++t) {
      const Tree& tree = system.trees[t];
      if (system.is_asleep(t)) continue;
      for (int corner = 0; corner < 4; ++corner) {
        const Vector3 local((corner & 1 ? 1 : -1) * side / 2, (corner & 2 ? 1 : -1) * side / 2,
                            -side / 2);
        const Vector3 point = tree.position[0] + tree.rotation[0] * local;
        ContactPoint contact;
        contact.a.tree = t;
        contact.b.tree = t % height ? t - 1 : -1;
        const double floor = t % height ? system.trees[t - 1].position[0].z() + side / 2 : 0;
        contact.gap = point.z() - floor;
        contact.point = Vector3(point.x(), point.y(), floor);
        contact.friction = 0.5;
        contacts.push_back(contact);
      }
    }
    remember(contacts, before);
    const double start = cpu_seconds();
    system.step(0.01, contacts);
    if (i >= 50) total += cpu_seconds() - start;
  }
  std::printf("%5d towers of %d boxes, %s: %.3f us per box and substep\n", count, height,
              sleeps ? "asleep" : "awake", 1e6 * total / (steps - 50) / (count * height));
}

void bench_falling(int count) {
  System system;
  for (int i = 0; i < count; ++i) {
    Tree tree({solid(1, Vector3(1e-3, 2e-3, 2.5e-3))}, {Vector3(i, 0, 0), Quaternion::Identity()});
    tree.gravity = Vector3(0, 0, -g);
    tree.v = {1, 2, 3, 0, 0, 0};
    system.trees.push_back(tree);
  }
  const double start = cpu_seconds();
  for (int i = 0; i < 100; ++i) system.step(0.01, {});
  std::printf("%5d tumbling bodies: %.2f us per body and substep\n", count,
              1e6 * (cpu_seconds() - start) / 100 / count);
}

/// @param verbose  a line per substep
void bench_pile(int count, int steps, double hz, bool verbose) {
  testing::Touching world = testing::pile(count);
  double total = 0, worst_time = 0, deepest = 0;
  std::vector<double> misses;
  std::size_t points = 0;
  long iterations = 0, descents = 0, interior = 0, passes = 0;
  for (int i = 0; i < steps; ++i) {
    for (Tree& tree : world.system.trees) tree.gravity = Vector3(0, 0, -g);
    world.find(1 / hz);
    const double start = cpu_seconds();
    const Report report = world.system.step(1 / hz, world.contacts);
    const double time = cpu_seconds() - start;
    total += time;
    worst_time = std::max(worst_time, time);
    misses.push_back(report.residual);
    points = std::max(points, world.contacts.size());
    iterations += report.most_iterations, descents += report.most_augmented_lagrangian_steps,
        interior += report.most_interior_point_steps;
    passes += report.most_passes;
    for (const ContactPoint& contact : world.contacts) deepest = std::max(deepest, -contact.gap);
    if (verbose) {
      std::printf(
          "%4d: %5zu points, %2d iterations, %3d descents, %2d interior, %3d passes, miss %.1e, "
          "%.2f ms\n",
          i, world.contacts.size(), report.most_iterations, report.most_augmented_lagrangian_steps,
          report.most_interior_point_steps, report.most_passes, report.residual, 1e3 * time);
    }
  }
  double energy = 0, highest = 0;
  for (const Tree& tree : world.system.trees) {
    energy += kinetic_energy(tree);
    highest = std::max(highest, tree.position[0].z());
  }
  const auto over = [&](double bound) {
    return std::count_if(misses.begin(), misses.end(), [&](double m) { return m > bound; });
  };
  std::printf(
      "%5d cubes in a bin, %d substeps at %g Hz, up to %zu points: %.2f ms, at most %.1f\n"
      "      miss > 1e-4 m/s: %ld, > 1e-3: %ld, worst %.1e; per substep %.1f iterations, "
      "%.1f descents, %.1f interior, %.1f passes\n"
      "      overlap %.2f mm, energy left %.1e J, top %.3f m\n",
      count, steps, hz, points, 1e3 * total / steps, 1e3 * worst_time, long(over(1e-4)),
      long(over(1e-3)), *std::max_element(misses.begin(), misses.end()), double(iterations) / steps,
      double(descents) / steps, double(interior) / steps, double(passes) / steps, 1e3 * deepest,
      energy, highest);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3 && std::string_view(argv[1]) == "robots") {
    bench_robots(std::atoi(argv[2]));
    return 0;
  }
  if (argc > 1) {
    bench_pile(std::atoi(argv[1]), argc > 2 ? std::atoi(argv[2]) : 150,
               argc > 3 ? std::atof(argv[3]) : 100, argc > 4);
    return 0;
  }
  for (const int count : {1, 16, 256, 1024}) bench_robots(count);
  for (const bool sleeps : {false, true}) {
    for (const int count : {1, 256, 2000}) bench_boxes(count, 1, sleeps);
    bench_boxes(4, 10, sleeps);
    bench_boxes(4, 20, sleeps);
  }
  bench_falling(1000);
}
