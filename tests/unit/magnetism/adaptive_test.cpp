// SPDX-License-Identifier: MIT
#include "magnetism/adaptive.h"

#include <gtest/gtest.h>

#include <cmath>

#include "magnetism/closed_forms.h"
#include "magnetism/exact_field.h"
#include "magnetism/field.h"
#include "math/random.h"

namespace ziggurat::magnetism {
namespace {

constexpr double remanence = 1.3;  // [T]
// From 5 % of the magnet's size to twenty sizes.
// (bench/magnetism_accuracy tests more gaps, shapes and poses.)
const std::vector<double> gaps = {0.05, 0.14, 0.45, 0.9, 1.1, 1.6, 2.5, 4, 20};

struct Pose2 {
  const char* name;
  Vector3 direction;    // from the second to the first
  Vector3 side_shift;   // in sides
  Quaternion rotation;  // of the first
};

Quaternion turned_by(double y, double x) {
  return Quaternion(Eigen::AngleAxisd(y * pi / 180, Vector3::UnitY())) *
         Quaternion(Eigen::AngleAxisd(x * pi / 180, Vector3::UnitX()));
}

const std::vector<Pose2> poses = {
    {"axial", {0, 0, 1}, {0, 0, 0}, turned_by(0, 0)},
    {"offset", {0, 0, 1}, {0.5, 0, 0}, turned_by(0, 0)},
    {"side by side, shifted", {1, 0, 0}, {0, 0, 0.4}, turned_by(0, 0)},
    {"rotated, offset", {0, 0, 1}, {0.4, 0.1, 0}, turned_by(-25, 35)},
    {"perpendicular", {0, 0, 1}, {0, 0, 0}, turned_by(90, 0)},
};

/// Half the extent of a shape along a unit direction [m].
double support(const Shape& shape, const Vector3& direction) {
  if (const auto* box = std::get_if<Box>(&shape)) return box->size.dot(direction.cwiseAbs()) / 2;
  const auto& cylinder = std::get<Cylinder>(shape);
  return cylinder.radius * std::hypot(direction.x(), direction.y()) +
         cylinder.height / 2 * std::fabs(direction.z());
}

/// Two magnets of shapes a and b in a pose: positions such that the gap between them is as given.
struct Arrangement {
  PlacedShape first, second;
};

Arrangement arrange(const Shape& a, const Shape& b, const Pose2& pose, double gap,
                    const Vector3& magnetised) {
  const double side = std::max(longest_side(a), longest_side(b));
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  const double distance =
      support(a, rotation.transpose() * pose.direction) + support(b, pose.direction) + gap * side;
  const Vector3 at = distance * pose.direction + side * pose.side_shift;
  return {{&a, at, rotation, rotation * moment_of_remanence(magnetised, volume(a))},
          {&b, Vector3::Zero(), Eigen::Matrix3d::Identity(),
           moment_of_remanence(magnetised, volume(b))}};
}

/// The result of class Field, as physics uses it: one magnet per body.
Interaction by_field(const Arrangement& two, double tolerance) {
  std::vector<Magnet> magnets(2);
  magnets[0] = {.body = 0,
                .passive_moment = two.first.rotation.transpose() * two.first.moment,
                .shape = *two.first.shape};
  magnets[1] = {.body = 1, .passive_moment = two.second.moment, .shape = *two.second.shape};
  Options options;
  options.precision = Precision::adaptive;
  options.tolerance = tolerance;
  Field field(magnets, 2, options);
  const std::vector<Pose> bodies = {{two.first.position, Quaternion(two.first.rotation)},
                                    {two.second.position, Quaternion::Identity()}};
  const std::vector<double> currents = {0, 0};
  std::vector<Wrench> wrenches(2);
  field.evaluate(0, bodies, currents, wrenches);
  const Vector3 sum =
      wrenches[0].torque + wrenches[1].torque + two.first.position.cross(wrenches[0].force);
  const double scale = wrenches[0].torque.norm() + wrenches[1].torque.norm() +
                       two.first.position.norm() * wrenches[0].force.norm();
  EXPECT_LE(sum.norm(), 1e-12 * scale);
  EXPECT_LE((wrenches[0].force + wrenches[1].force).norm(), 1e-12 * wrenches[0].force.norm());
  return {wrenches[0].force, wrenches[0].torque, wrenches[1].torque};
}

struct Errors {
  double force, torque;
};

/// Torque relative to max(|T|, |F| side / 2).
Errors errors(const Interaction& actual, const Interaction& exact, double side) {
  const double force = exact.force_on_first.norm();
  const auto torque = [&](const Vector3& a, const Vector3& e) {
    return (a - e).norm() / std::max(e.norm(), force * side / 2);
  };
  return {(actual.force_on_first - exact.force_on_first).norm() / force,
          std::max(torque(actual.torque_on_first, exact.torque_on_first),
                   torque(actual.torque_on_second, exact.torque_on_second))};
}

void expect_within(const Shape& a, const Shape& b, double tolerance, const Vector3& magnetised,
                   const char* label) {
  const double side = std::max(longest_side(a), longest_side(b));
  for (const Pose2& pose : poses) {
    for (const double gap : gaps) {
      const Arrangement two = arrange(a, b, pose, gap, magnetised);
      const Errors e = errors(by_field(two, tolerance),
                              charge_pair(two.first, two.second, tolerance / 10), side);
      EXPECT_LE(e.force, tolerance) << label << " " << pose.name << " gap " << gap << " sides";
      EXPECT_LE(e.torque, tolerance) << label << " " << pose.name << " gap " << gap << " sides";
    }
  }
}

const Vector3 along_z(0, 0, remanence);
const Vector3 skew(0.4, -0.5, 1.1);

TEST(ClosedForms, BoxesMatchThePublishedFigure) {
  const Vector3 force = parallel_box_force({0.020, 0.012, 0.006}, {0.012, 0.020, 0.006},
                                           {-0.004, -0.004, 0.008}, 0.38, 0.38);
  EXPECT_NEAR(force.x(), 0.588, 1e-3);
  EXPECT_NEAR(force.y(), 0.588, 1e-3);
  EXPECT_NEAR(force.z(), -1.774, 1e-3);
}

TEST(ClosedForms, BecomeDipolesFarAway) {
  const double m = moment_of_remanence({0, 0, remanence}, 1e-6).z();
  const double box = parallel_box_force(Vector3::Constant(0.01), Vector3::Constant(0.01),
                                        {0, 0, 0.3}, remanence, remanence)
                         .z();
  EXPECT_NEAR(box, -6e-7 * m * m / std::pow(0.3, 4), 1e-5 * std::fabs(box));
  const double mc = moment_of_remanence({0, 0, remanence}, pi * 25e-6 * 0.01).z();
  const double cylinder = coaxial_cylinder_force(0.005, 0.01, 0.01, 1.99, remanence, remanence);
  EXPECT_NEAR(cylinder, 6e-7 * mc * mc / std::pow(2.0, 4), 5e-3 * cylinder);
}

TEST(Charges, MatchAkounAndYonnetForParallelBoxes) {
  const Shape a = Box{{0.01, 0.008, 0.006}};
  const Shape b = Box{{0.006, 0.009, 0.012}};
  for (const double gap : {0.05, 0.2, 1.0, 5.0}) {
    const Pose2 pose{"", {0, 0, 1}, {0.3, -0.2, 0}, Quaternion::Identity()};
    const Arrangement two = arrange(a, b, pose, gap, along_z);
    const Vector3 exact = parallel_box_force(std::get<Box>(b).size, std::get<Box>(a).size,
                                             two.first.position, remanence, remanence);
    const Vector3 force = charge_pair(two.first, two.second, 1e-5).force_on_first;
    EXPECT_LE((force - exact).norm(), 3e-5 * exact.norm()) << gap;
  }
}

TEST(Charges, MatchTheAxialIntegralForCylinders) {
  for (const double height : {0.005, 0.01, 0.02}) {
    const Shape shape = Cylinder{0.005, height};
    const double side = longest_side(shape);
    for (const double gap : {0.05, 0.2, 1.0, 5.0}) {
      const Arrangement two = arrange(shape, shape, poses[0], gap, along_z);
      const double exact =
          coaxial_cylinder_force(0.005, height, height, gap * side, remanence, remanence);
      EXPECT_NEAR(charge_pair(two.first, two.second, 1e-5).force_on_first.z(), -exact,
                  3e-4 * exact);
    }
  }
}

TEST(Charges, OfAPointAtTheCentreOfAMagnetAreFinite) {
  const Shape point = PointShape{};
  const Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  for (const Shape& shape : {Shape(Box{{0.01, 0.01, 0.02}}), Shape(Cylinder{0.005, 0.02})}) {
    for (const Vector3& moment : {Vector3(0, 0, 1), Vector3(1, 0, 0), Vector3(0.6, 0, 0.8)}) {
      const Interaction at_centre = charge_pair({&shape, Vector3::Zero(), axes, Vector3(0, 0, 1)},
                                                {&point, Vector3::Zero(), axes, moment}, 0.01);
      EXPECT_TRUE(at_centre.force_on_first.allFinite());
      EXPECT_TRUE(at_centre.torque_on_first.allFinite());
      EXPECT_EQ(at_centre.torque_on_first, -at_centre.torque_on_second);
    }
  }
}

TEST(ExactField, APointOnTheAxisOfALongCylinderLeavesItByItsSide) {
  const Vector3 point = outside(Cylinder{0.002, 0.05}, {0, 0, 0.001});
  EXPECT_NEAR(std::hypot(point.x(), point.y()), 0.002, 1e-10);
  EXPECT_EQ(point.z(), 0.001);
}

TEST(ExactField, OfACylinderMatchesItsOwnVolumeOfDipoles) {
  const Shape shape = Cylinder{0.005, 0.007};
  const Vector3 moment(0.1, -0.2, 0.3);
  const Vector3 point(0.009, 0.005, 0.007);
  Vector3 sum = Vector3::Zero();
  constexpr int n = 40;
  for (int i = 0; i < n * n * n; ++i) {
    const double r = 0.005 * std::sqrt((i % n + 0.5) / n);
    const double angle = 2 * pi * (i / n % n + 0.5) / n;
    const Vector3 at(r * std::cos(angle), r * std::sin(angle),
                     0.007 * ((i / n / n + 0.5) / n - 0.5));
    sum += dipole_field(moment, point - at);
  }
  const Vector3 exact = shape_field(shape, moment, point, 1e-10);
  EXPECT_LE((sum / (n * n * n) - exact).norm(), 2e-4 * exact.norm());
}

TEST(Adaptive, CubesMatchAkounAndYonnetAtEveryGap) {
  const Shape cube = Box{Vector3::Constant(0.01)};
  const Vector3 size = Vector3::Constant(0.01);
  for (const double tolerance : {0.1, 0.01, 0.001}) {
    for (const int pose : {0, 1, 2}) {
      for (const double gap : gaps) {
        const Arrangement two = arrange(cube, cube, poses[pose], gap, along_z);
        const Vector3 exact =
            parallel_box_force(size, size, two.first.position, remanence, remanence);
        EXPECT_LE((by_field(two, tolerance).force_on_first - exact).norm(),
                  tolerance * exact.norm())
            << poses[pose].name << " gap " << gap;
      }
    }
  }
}

/// Two alike boxes magnetised along z, one on top of the other or beside it, shifted by shares of
/// their size, with a gap [m].
struct Touching {
  Vector3 size, offset;
  Shape box{Box{size}};

  PlacedShape placed(const Vector3& at) const {
    return {&box, at, Eigen::Matrix3d::Identity(), moment_of_remanence(along_z, volume(box))};
  }
  Interaction computed(double tolerance) const {
    return by_field({placed(offset), placed(Vector3::Zero())}, tolerance);
  }
  double error(double tolerance) const {
    const Vector3 exact = parallel_box_force(size, size, offset, remanence, remanence);
    return (computed(tolerance).force_on_first - exact).norm() / exact.norm();
  }
};

TEST(Adaptive, ShiftedPlatesThatTouchStayWithinTheTolerance) {
  const Vector3 sizes[] = {
      {0.02, 0.02, 0.001}, {0.02, 0.02, 0.0005}, {0.04, 0.005, 0.001}, {0.01, 0.01, 0.01}};
  const Vector3 shifts[] = {{0, 0, 0}, {0.25, 0, 0}, {0.5, 0.1, 0}, {0.33, 0.47, 0}, {0.9, 0.3, 0}};
  for (const Vector3& size : sizes) {
    for (const Vector3& shift : shifts) {
      for (const double gap : {0.0, 1e-6, 1e-4, 3e-4}) {
        const Vector3 above{shift.x() * size.x(), shift.y() * size.y(), size.z() + gap};
        const Vector3 beside{size.x() + gap, shift.y() * size.y(), shift.x() * size.z()};
        EXPECT_LE((Touching{size, above}.error(0.01)), 0.01) << shift.transpose() << ", " << gap;
        EXPECT_LE((Touching{size, beside}.error(0.01)), 0.01) << shift.transpose() << ", " << gap;
      }
    }
  }
}

TEST(Adaptive, TheForceHasNoJumpWhereBoxesBeginToOverlap) {
  for (const Vector3& size : {Vector3(0.02, 0.02, 0.001), Vector3(0.01, 0.01, 0.01)}) {
    const auto force = [&](double gap) {
      return Touching{size, {0.3 * size.x(), 0, size.z() + gap}}.computed(0.01).force_on_first;
    };
    EXPECT_LE((force(-1e-6) - force(1e-6)).norm(), 0.02 * force(1e-6).norm());
    EXPECT_LE((force(-1e-5) - force(1e-5)).norm(), 0.1 * force(1e-5).norm());
  }
}

TEST(Adaptive, TheForceHasNoJumpWhereCylindersBeginToOverlap) {
  const Shape disc = Cylinder{0.01, 0.002};
  const auto force = [&](double gap) {
    const Vector3 moment = moment_of_remanence(along_z, volume(disc));
    const PlacedShape lower{&disc, Vector3::Zero(), Eigen::Matrix3d::Identity(), moment};
    const PlacedShape upper{&disc, {0, 0, 0.002 + gap}, Eigen::Matrix3d::Identity(), moment};
    return charge_pair(upper, lower, 4e-3).force_on_first.z();
  };
  const double exact = -coaxial_cylinder_force(0.01, 0.002, 0.002, 1e-5, remanence, remanence);
  EXPECT_NEAR(force(1e-5), exact, 0.01 * std::fabs(exact));
  EXPECT_NEAR(force(-1e-6), exact, 0.03 * std::fabs(exact));
}

TEST(Adaptive, CubesStayWithinTheTolerance) {
  const Shape cube = Box{Vector3::Constant(0.01)};
  expect_within(cube, cube, 0.01, along_z, "cube");
  expect_within(cube, cube, 0.1, skew, "skew cube");
}

TEST(Adaptive, ForceAndTorqueStepByLessThanTheToleranceBetweenLevels) {
  const double tolerance = 0.01;
  for (const Shape& shape : {Shape(Box{Vector3::Constant(0.01)}), Shape(Box{{0.01, 0.01, 0.005}}),
                             Shape(Cylinder{0.005, 0.01})}) {
    const Reach at = reach(shape, 0.8 * tolerance);
    for (const double distance : {at.point, at.coarse, at.mixed, at.fine}) {
      for (const Pose2& pose : poses) {
        // Along the line of centres, just inside and just outside.
        const Vector3 line = (pose.direction + 0.3 * pose.side_shift).normalized();
        Arrangement two = arrange(shape, shape, pose, 1, along_z);
        two.first.position = (distance - 1e-9) * line;
        const Interaction inside = by_field(two, tolerance);
        two.first.position = (distance + 1e-9) * line;
        const Errors step = errors(inside, by_field(two, tolerance), longest_side(shape));
        EXPECT_LE(step.force, tolerance) << pose.name << " at " << distance;
        EXPECT_LE(step.torque, tolerance) << pose.name << " at " << distance;
      }
    }
  }
}

TEST(Adaptive, ASphereIsExactlyOneDipole) {
  const Shape sphere = Sphere{0.003};
  const double m = moment_of_remanence(along_z, volume(sphere)).z();
  std::vector<Magnet> magnets(2);
  magnets[0] = {.body = 0, .passive_moment = {0, 0, m}, .shape = sphere};
  magnets[1] = {.body = 1, .passive_moment = {m, 0, 0}, .shape = sphere};
  Options options;
  options.precision = Precision::adaptive;
  Field field(magnets, 2, options);
  const std::vector<Pose> bodies = {{}, {{0.002, 0.001, 0.007}, Quaternion::Identity()}};
  const std::vector<double> currents = {0, 0};
  std::vector<Wrench> wrenches(2);
  field.evaluate(0, bodies, currents, wrenches);
  const auto pair = dipole_pair({0, 0, m}, {m, 0, 0}, -bodies[1].position);
  EXPECT_LE((wrenches[0].force - pair.force_on_first).norm(), 1e-14 * pair.force_on_first.norm());
}

TEST(Adaptive, ADipoleNearABoxFeelsItsExactField) {
  const Vector3 size(0.02, 0.01, 0.01);
  std::vector<Magnet> magnets(2);
  magnets[0] = {
      .body = 0, .passive_moment = moment_of_remanence(along_z, 2e-6), .shape = Box{size}};
  magnets[1] = {.body = 1, .passive_moment = {0.02, 0.01, 0.03}};
  Options options;
  options.precision = Precision::adaptive;
  Field field(magnets, 2, options);
  const std::vector<double> currents = {0, 0};
  const Vector3 magnetisation = along_z / vacuum_permeability;
  for (const double height : {0.0055, 0.007, 0.012, 0.03, 0.2}) {
    const Vector3 at(0.004, 0.003, height);
    const std::vector<Pose> bodies = {{}, {at, Quaternion::Identity()}};
    std::vector<Wrench> wrenches(2);
    field.evaluate(0, bodies, currents, wrenches);
    const Vector3& m = magnets[1].passive_moment;
    const Vector3 torque = m.cross(box_field(size, magnetisation, at));
    Vector3 force;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3 shift = 1e-6 * Vector3::Unit(axis);
      force[axis] = m.dot(box_field(size, magnetisation, at + shift) -
                          box_field(size, magnetisation, at - shift)) /
                    2e-6;
    }
    EXPECT_LE((wrenches[1].force - force).norm(), 0.01 * force.norm()) << height;
    EXPECT_LE((wrenches[1].torque - torque).norm(), 0.01 * torque.norm()) << height;
  }
}

TEST(Adaptive, HasTheSameBitsOnEveryInstructionSetAndWithoutAList) {
  math::RandomStream random(12, "adaptive");
  std::vector<Magnet> magnets;
  std::vector<Pose> bodies;
  const Shape shapes[] = {Box{Vector3::Constant(0.006)}, Cylinder{0.003, 0.004},
                          Box{{0.01, 0.005, 0.004}}, Sphere{0.003}, PointShape{}};
  for (int i = 0; i < 60; ++i) {
    const Vector3 moment(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), 0.1);
    magnets.push_back({.body = static_cast<std::uint32_t>(i),
                       .passive_moment = moment,
                       .shape = shapes[i % 5],
                       .freely_turning = i % 5 == 3});
    const Vector3 place(i % 4, i / 4 % 4, i / 16);
    const double x = random.uniform(0, 0.002);
    bodies.push_back({0.015 * place + Vector3(x, 0, 0),
                      turned_by(random.uniform(0, 90), random.uniform(0, 90))});
  }
  Options options;
  options.precision = Precision::adaptive;
  options.max_distance = 0.04;
  std::vector<std::vector<Wrench>> results;
  for (const Kernel* kernel : {&baseline_kernel(), &best_kernel()}) {
    for (const std::size_t idle :
         {0, 2000}) {  // with 2000 idle magnets, all pairs are faster than a list
      options.kernel = kernel;
      auto all = magnets;
      auto where = bodies;
      for (std::size_t k = 0; k < idle; ++k) {
        all.push_back({.body = static_cast<std::uint32_t>(where.size())});
        where.emplace_back();
      }
      std::vector<Wrench> wrenches(where.size());
      Field field(all, where.size(), options);
      field.evaluate(0.01, where, std::vector<double>(where.size(), 0), wrenches);
      wrenches.resize(60);
      results.push_back(wrenches);
    }
  }
  for (const auto& result : results) {
    for (std::size_t i = 0; i < result.size(); ++i) {
      EXPECT_EQ(result[i].force, results[0][i].force);
      EXPECT_EQ(result[i].torque, results[0][i].torque);
    }
  }
}

TEST(Adaptive, CuboidsStayWithinOnePercent) {
  for (const Vector3& size : {Vector3(10, 10, 5), Vector3(5, 5, 10), Vector3(10, 7, 6)}) {
    const Shape shape = Box{size * 1e-3};
    expect_within(shape, shape, 0.01, along_z, "cuboid");
  }
}

TEST(Adaptive, CylindersStayWithinOnePercent) {
  for (const double height : {0.005, 0.01}) {
    const Shape shape = Cylinder{0.005, height};
    expect_within(shape, shape, 0.01, along_z, "cylinder");
  }
}

}  // namespace
}  // namespace ziggurat::magnetism
