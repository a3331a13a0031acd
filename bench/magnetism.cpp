// SPDX-License-Identifier: MIT
// Magnetism: the neighbour list and its kernels compared with simple loops, all with the project's
// release flags. Blocks of eight dipoles on a 60 mm lattice; each block moves on a circle at 5 cm/s
// with its own phase, in 10 ms substeps, so that lists are rebuilt as in a real run. Every variant
// computes wrenches from poses. Thread CPU time, median over steps; only ratios are comparable
// between machines.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "magnetism/field.h"
#include "math/random.h"

namespace {

using namespace ziggurat;
using magnetism::Field;
using magnetism::Magnet;
using magnetism::Options;
using magnetism::Wrench;
using math::Pose;
using math::Vector3;

constexpr double substep = 0.01;   // [s]
constexpr double speed = 0.05;     // [m/s]
constexpr double circle = 0.002;   // radius of each block's motion [m]
constexpr double pitch = 0.06;     // of the lattice [m]
constexpr double corner = 0.0225;  // of a dipole from the block's centre, per axis [m]
constexpr double moment = 0.1726;  // a dialect field of 65 [A m^2]
constexpr double unlimited = std::numeric_limits<double>::infinity();

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Lattice {
  std::vector<Magnet> magnets;
  std::vector<Vector3> centres;
  std::vector<double> phases;
  std::vector<Pose> poses;
  std::vector<double> currents;
  std::vector<Wrench> wrenches;

  bool drifting =
      false;  ///< all blocks move together in a straight line; otherwise each on its circle

  void move(int step) {
    for (std::size_t b = 0; b < poses.size(); ++b) {
      if (drifting) {
        poses[b].position = centres[b] + Vector3(0.6, 0.64, 0.48) * (speed * substep * step);
        continue;
      }
      const double angle = phases[b] + speed / circle * substep * step;
      poses[b].position = centres[b] + circle * Vector3(std::cos(angle), std::sin(angle), 0);
    }
  }
};

Lattice lattice(std::size_t dipoles, const magnetism::Shape& shape) {
  math::RandomStream random(1, "bench");
  Lattice result;
  const auto blocks = (dipoles + 7) / 8;
  const auto side =
      static_cast<std::size_t>(std::ceil(std::cbrt(static_cast<double>(blocks)) - 1e-9));
  for (std::size_t b = 0; b < blocks; ++b) {
    result.centres.emplace_back(pitch * static_cast<double>(b % side),
                                pitch * static_cast<double>(b / side % side),
                                pitch * static_cast<double>(b / side / side));
    result.phases.push_back(random.uniform(0, 6.28));
    const Vector3 axis(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    // Each block is turned a little, as after a fall.
    result.poses.push_back(
        {Vector3::Zero(), math::Quaternion(Eigen::AngleAxisd(0.02, axis.normalized()))});
    for (int k = 0; k < 8 && result.magnets.size() < dipoles; ++k) {
      Magnet magnet;
      magnet.body = static_cast<std::uint32_t>(b);
      magnet.position = {k & 1 ? corner : -corner, k & 2 ? corner : -corner,
                         k & 4 ? corner : -corner};
      const Vector3 direction(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      magnet.passive_moment = moment * direction.normalized();
      magnet.shape = shape;
      result.magnets.push_back(magnet);
    }
  }
  result.currents.assign(result.magnets.size(), 0);
  result.wrenches.resize(blocks);
  return result;
}

void add_pair(const Magnet& a, const Magnet& b, const Vector3& p1, const Vector3& p2,
              const Vector3& m1, const Vector3& m2, double max_distance, Lattice& scene) {
  const Vector3 r = p1 - p2;
  const double d = r.norm();
  if (d > max_distance) return;
  const Vector3 n = r / d;
  const double k4 = 3 * magnetism::magnetic_constant / (d * d * d * d);
  const double k3 = magnetism::magnetic_constant / (d * d * d);
  const double a1 = m1.dot(n);
  const double a2 = m2.dot(n);
  const Vector3 force = k4 * (a2 * m1 + a1 * m2 + m1.dot(m2) * n - 5 * a1 * a2 * n);
  const Vector3 torque1 = k3 * (3 * a2 * m1.cross(n) - m1.cross(m2));
  const Vector3 torque2 = k3 * (3 * a1 * m2.cross(n) + m1.cross(m2));
  Wrench& w1 = scene.wrenches[a.body];
  Wrench& w2 = scene.wrenches[b.body];
  w1.force += force;
  w1.torque += torque1 + (p1 - scene.poses[a.body].position).cross(force);
  w2.force -= force;
  w2.torque += torque2 - (p2 - scene.poses[b.body].position).cross(force);
}

/// The simplest loop: computes positions and moments again for every pair.
void straightforward(Lattice& scene, double max_distance) {
  std::fill(scene.wrenches.begin(), scene.wrenches.end(), Wrench{});
  for (std::size_t i = 0; i < scene.magnets.size(); ++i) {
    for (std::size_t j = i + 1; j < scene.magnets.size(); ++j) {
      const Magnet& a = scene.magnets[i];
      const Magnet& b = scene.magnets[j];
      const Pose& x1 = scene.poses[a.body];
      const Pose& x2 = scene.poses[b.body];
      add_pair(a, b, x1 * a.position, x2 * b.position,
               x1.orientation * (a.passive_moment + scene.currents[i] * a.active_moment),
               x2.orientation * (b.passive_moment + scene.currents[j] * b.active_moment),
               max_distance, scene);
    }
  }
}

/// A first improvement: computes positions and moments once per step.
void placed_once(Lattice& scene, double max_distance) {
  struct Placed {
    Vector3 position, moment;
    const Magnet* magnet;
  };
  static std::vector<Placed> placed;
  placed.clear();
  std::fill(scene.wrenches.begin(), scene.wrenches.end(), Wrench{});
  for (std::size_t i = 0; i < scene.magnets.size(); ++i) {
    const Magnet& m = scene.magnets[i];
    const Pose& x = scene.poses[m.body];
    placed.push_back({x * m.position,
                      x.orientation * (m.passive_moment + scene.currents[i] * m.active_moment),
                      &m});
  }
  for (std::size_t i = 0; i < placed.size(); ++i) {
    for (std::size_t j = i + 1; j < placed.size(); ++j) {
      add_pair(*placed[i].magnet, *placed[j].magnet, placed[i].position, placed[j].position,
               placed[i].moment, placed[j].moment, max_distance, scene);
    }
  }
}

/// Median over rounds of a step's mean CPU time, rebuilds of the list included [s].
double mean_time(Lattice& scene, int steps, const std::function<void()>& evaluate) {
  std::vector<double> rounds;
  for (int round = 0; round < 5; ++round) {
    double sum = 0;
    for (int step = 0; step < steps; ++step) {
      scene.move(step);
      const double start = cpu_seconds();
      evaluate();
      sum += cpu_seconds() - start;
    }
    rounds.push_back(sum / steps);
    if (sum > 1) break;
  }
  std::sort(rounds.begin(), rounds.end());
  return rounds[rounds.size() / 2];
}

double time_field(Lattice& scene, const Options& options, int steps, double* rebuild_share) {
  Field field(scene.magnets, scene.poses.size(), options);
  const double time = mean_time(
      scene, steps, [&] { field.evaluate(substep, scene.poses, scene.currents, scene.wrenches); });
  if (rebuild_share != nullptr)
    *rebuild_share = static_cast<double>(field.rebuilds()) / (5 * steps);
  return time;
}

std::size_t pairs_in_range(const Lattice& scene, double max_distance) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < scene.magnets.size(); ++i) {
    const Vector3 p = scene.poses[scene.magnets[i].body] * scene.magnets[i].position;
    for (std::size_t j = i + 1; j < scene.magnets.size(); ++j) {
      const Vector3 q = scene.poses[scene.magnets[j].body] * scene.magnets[j].position;
      count += (p - q).squaredNorm() <= max_distance * max_distance &&
               scene.magnets[i].body != scene.magnets[j].body;
    }
  }
  return count;
}

void compare(std::size_t dipoles, double max_distance, const magnetism::Shape& cube) {
  Lattice scene = lattice(dipoles, magnetism::PointShape{});
  const bool limited = max_distance < unlimited;
  const auto n = static_cast<double>(dipoles);
  const int steps = limited ? std::max(100, static_cast<int>(4e6 / n) / 10) : 10;
  const int slow_steps = std::clamp(static_cast<int>(2e8 / (n * n)), 1, 2000);
  Options options;
  options.max_distance = max_distance;
  double rebuilds = 0;
  const double ours =
      time_field(scene, options, std::min(steps, limited ? steps : slow_steps), &rebuilds);
  const double pairs =
      limited ? static_cast<double>(pairs_in_range(scene, max_distance)) : n * (n - 1) / 2;
  std::printf("%6zu  %9s  %9.0f  %10.2f  %7.2f  %5.2f", dipoles,
              limited ? std::to_string(max_distance).substr(0, 4).c_str() : "none", pairs,
              ours * 1e6, ours * 1e9 / pairs, rebuilds);
  if (dipoles <= 6400) {
    const double plain =
        mean_time(scene, slow_steps, [&] { straightforward(scene, max_distance); });
    const double placed = mean_time(scene, slow_steps, [&] { placed_once(scene, max_distance); });
    std::printf("  %8.1fx %8.1fx", plain / ours, placed / ours);
  } else {
    std::printf("  %9s %9s", "-", "-");
  }
  if (limited) {
    Options adaptive = options;
    adaptive.precision = magnetism::Precision::adaptive;
    Lattice cubes = lattice(dipoles, cube);
    std::printf("  %7.2f", time_field(cubes, adaptive, steps, nullptr) / ours);
    Lattice drifting = lattice(dipoles, magnetism::PointShape{});
    drifting.drifting = cubes.drifting = true;
    const double alone = time_field(drifting, options, steps, nullptr);
    std::printf("  %7.2f", time_field(cubes, adaptive, steps, nullptr) / alone);
    Lattice free = lattice(dipoles, magnetism::PointShape{});
    for (Magnet& magnet : free.magnets) magnet.freely_turning = true;
    std::printf("  %7.2f", time_field(free, options, steps, nullptr) / ours);
    options.kernel = &magnetism::baseline_kernel();
    std::printf("  %7.2f", time_field(scene, options, steps, nullptr) / ours);
  }
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char**) {
  std::printf("kernel: %s\n", magnetism::best_kernel().name);
  std::printf("%6s  %9s  %9s  %10s  %7s  %5s  %9s %9s  %7s  %7s  %7s  %7s\n", "N", "cut-off m",
              "pairs", "us/step", "ns/pair", "lists", "plain", "placed", "cubes", "drift", "free",
              "SSE2");
  const magnetism::Box cube{Vector3::Constant(0.006)};
  if (argc < 2)
    for (const std::size_t n : {20, 160, 1600, 6400, 25600}) compare(n, 0.04, cube);
  for (const std::size_t n : {20, 160, 1600}) compare(n, unlimited, cube);
}
