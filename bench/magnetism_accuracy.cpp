// SPDX-License-Identifier: MIT
// Accuracy of the adaptive magnets: worst errors over gaps from 5 % of the magnet's size to twenty
// sizes and over random poses, relative to a fine integration over pole charges (which the unit
// tests compare with Akoun and Yonnet and with the axial integral for cylinders). Torque errors are
// relative to max(|T|, |F| side / 2). Prints for each shape and tolerance the worst errors of force
// and torque, the number of poses outside the tolerance, and the mean time of a pair.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <vector>

#include "magnetism/charges.h"
#include "magnetism/field.h"
#include "math/random.h"

namespace {

using namespace ziggurat;
using namespace ziggurat::magnetism;

constexpr int random_poses = 12;
const std::vector<double> gaps = {0.05, 0.07, 0.1, 0.14, 0.2, 0.3, 0.45, 0.65, 0.9, 1.1,
                                  1.3,  1.6,  2,   2.5,  3,   4,   6,    9,    14,  20};

double support(const Shape& shape, const Vector3& direction) {
  if (const auto* box = std::get_if<Box>(&shape)) return box->size.dot(direction.cwiseAbs()) / 2;
  const auto& cylinder = std::get<Cylinder>(shape);
  return cylinder.radius * std::hypot(direction.x(), direction.y()) +
         cylinder.height / 2 * std::fabs(direction.z());
}

struct Worst {
  double force = 0;
  double torque = 0;
  int outside = 0;
  int count = 0;
  double seconds = 0;
};

void measure(const Shape& shape, const PlacedShape& first, const PlacedShape& second,
             double tolerance, Worst& worst) {
  std::vector<Magnet> magnets(2);
  magnets[0].passive_moment = first.rotation.transpose() * first.moment;
  magnets[1].passive_moment = second.moment;
  magnets[1].body = 1;
  magnets[0].shape = magnets[1].shape = shape;
  Options options;
  options.precision = Precision::adaptive;
  options.tolerance = tolerance;
  Field field(magnets, 2, options);
  const std::vector<Pose> bodies = {{first.position, Quaternion(first.rotation)}, {}};
  const std::vector<double> currents(2, 0);
  std::vector<Wrench> wrenches(2);
  const auto start = std::chrono::steady_clock::now();
  field.evaluate(0, bodies, currents, wrenches);
  worst.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const Interaction exact = charge_pair(first, second, tolerance / 30);
  const double force = exact.force_on_first.norm();
  const double side = longest_side(shape);
  const double force_error = (wrenches[0].force - exact.force_on_first).norm() / force;
  double torque_error = 0;
  const Vector3 torques[] = {exact.torque_on_first, exact.torque_on_second};
  for (int k = 0; k < 2; ++k) {
    torque_error = std::max(torque_error, (wrenches[k].torque - torques[k]).norm() /
                                              std::max(torques[k].norm(), force * side / 2));
  }
  worst.force = std::max(worst.force, force_error);
  worst.torque = std::max(worst.torque, torque_error);
  worst.outside += force_error > tolerance || torque_error > tolerance;
  ++worst.count;
}

void sweep(const char* name, const Shape& shape, double tolerance) {
  math::RandomStream random(1, name);
  const double side = longest_side(shape);
  const Vector3 moment = moment_of_remanence({0, 0, 1.3}, volume(shape));
  Worst worst;
  for (int pose = 0; pose < random_poses; ++pose) {
    // The first three axial, offset and side by side; the rest at random.
    Vector3 direction = pose == 2 ? Vector3::UnitX() : Vector3::UnitZ();
    Vector3 shift = pose == 1 ? Vector3(0.5, 0.2, 0) : Vector3(0, 0, 0);
    Quaternion turn = Quaternion::Identity();
    if (pose > 2) {
      shift = {random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), 0};
      const Vector3 axis(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      turn = Quaternion(Eigen::AngleAxisd(random.uniform(-0.8, 0.8), axis.normalized()));
    }
    const Eigen::Matrix3d rotation = turn.toRotationMatrix();
    for (const double gap : gaps) {
      const double distance =
          support(shape, rotation.transpose() * direction) + support(shape, direction) + gap * side;
      const PlacedShape first{&shape, distance * direction + side * shift, rotation,
                              rotation * moment};
      const PlacedShape second{&shape, Vector3::Zero(), Eigen::Matrix3d::Identity(), moment};
      measure(shape, first, second, tolerance, worst);
    }
  }
  std::printf("%-18s %6.1f %%  %8.3f %%  %8.3f %%  %4d of %d  %8.1f us\n", name, 100 * tolerance,
              100 * worst.force, 100 * worst.torque, worst.outside, worst.count,
              1e6 * worst.seconds / worst.count);
  std::fflush(stdout);
}

}  // namespace

int main() {
  struct Named {
    const char* name;
    Shape shape;
  };
  const Named shapes[] = {
      {"cube", Box{Vector3::Constant(0.01)}},      {"box 10 10 5", Box{{0.01, 0.01, 0.005}}},
      {"box 5 5 10", Box{{0.005, 0.005, 0.01}}},   {"box 10 7 6", Box{{0.01, 0.007, 0.006}}},
      {"cylinder 10 x 10", Cylinder{0.005, 0.01}}, {"cylinder 10 x 5", Cylinder{0.005, 0.005}},
      {"cylinder 5 x 10", Cylinder{0.0025, 0.01}}};
  std::printf("%-18s %8s  %10s  %10s  %s\n", "shape", "asked", "force", "torque", "outside, time");
  for (const Named& named : shapes) {
    for (const double tolerance : {0.1, 0.01, 0.001}) sweep(named.name, named.shape, tolerance);
  }
}
