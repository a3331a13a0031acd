// SPDX-License-Identifier: MIT
#include "magnetism/field.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "math/random.h"

namespace ziggurat::magnetism {
namespace {

struct Scene {
  std::vector<Magnet> magnets;
  std::vector<Pose> bodies;
  std::vector<double> currents;
};

Vector3 random_vector(math::RandomStream& random, double size) {
  const double x = random.uniform(-size, size);
  const double y = random.uniform(-size, size);
  return {x, y, random.uniform(-size, size)};
}

Quaternion random_rotation(math::RandomStream& random) {
  const Vector3 v = random_vector(random, 1);
  return Quaternion(random.uniform(-1, 1), v.x(), v.y(), v.z()).normalized();
}

/// Bodies with eight magnets each, one of which has a current, in a cube of the given size [m].
Scene random_scene(std::size_t bodies, double size, std::uint64_t seed) {
  math::RandomStream random(seed, "magnetism");
  Scene scene;
  for (std::size_t b = 0; b < bodies; ++b) {
    scene.bodies.push_back({random_vector(random, size / 2), random_rotation(random)});
    for (int k = 0; k < 8; ++k) {
      Magnet magnet;
      magnet.body = static_cast<std::uint32_t>(b);
      magnet.position = Vector3(k & 1 ? 0.02 : -0.02, k & 2 ? 0.02 : -0.02, k & 4 ? 0.02 : -0.02);
      magnet.passive_moment = random_vector(random, 0.2);
      magnet.active_moment = random_vector(random, 0.1);
      scene.magnets.push_back(magnet);
      scene.currents.push_back(k == 3 ? 0.5 : 0);
    }
  }
  return scene;
}

struct Result {
  std::vector<Wrench> wrenches;
  std::size_t rebuilds = 0;
};

Result run(const Scene& scene, const Options& options) {
  Field field(scene.magnets, scene.bodies.size(), options);
  Result result{std::vector<Wrench>(scene.bodies.size()), 0};
  field.evaluate(0.01, scene.bodies, scene.currents, result.wrenches);
  return result;
}

void expect_same_bits(std::span<const Wrench> a, std::span<const Wrench> b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(a[i].force[axis]),
                std::bit_cast<std::uint64_t>(b[i].force[axis]))
          << "body " << i;
      ASSERT_EQ(std::bit_cast<std::uint64_t>(a[i].torque[axis]),
                std::bit_cast<std::uint64_t>(b[i].torque[axis]))
          << "body " << i;
    }
  }
}

/// The simple loop over all pairs of magnets of different bodies.
std::vector<Wrench> reference(const Scene& scene, double max_distance) {
  std::vector<Wrench> wrenches(scene.bodies.size());
  const auto position = [&](std::size_t i) {
    return scene.bodies[scene.magnets[i].body] * scene.magnets[i].position;
  };
  const auto moment = [&](std::size_t i) -> Vector3 {
    const Magnet& m = scene.magnets[i];
    return scene.bodies[m.body].orientation *
           (m.passive_moment + scene.currents[i] * m.active_moment);
  };
  for (std::size_t i = 0; i < scene.magnets.size(); ++i) {
    for (std::size_t j = i + 1; j < scene.magnets.size(); ++j) {
      const auto a = scene.magnets[i].body;
      const auto b = scene.magnets[j].body;
      const Vector3 r = position(i) - position(j);
      if (a == b || r.norm() > max_distance) continue;
      const auto pair = dipole_pair(moment(i), moment(j), r);
      wrenches[a].force += pair.force_on_first;
      wrenches[b].force -= pair.force_on_first;
      wrenches[a].torque += pair.torque_on_first +
                            (position(i) - scene.bodies[a].position).cross(pair.force_on_first);
      wrenches[b].torque += pair.torque_on_second -
                            (position(j) - scene.bodies[b].position).cross(pair.force_on_first);
    }
  }
  return wrenches;
}

void expect_near(std::span<const Wrench> actual, std::span<const Wrench> expected,
                 double tolerance) {
  for (std::size_t i = 0; i < actual.size(); ++i) {
    const double force = expected[i].force.norm();
    EXPECT_LE((actual[i].force - expected[i].force).norm(), tolerance * force);
    EXPECT_LE((actual[i].torque - expected[i].torque).norm(),
              tolerance * (expected[i].torque.norm() + 0.03 * force));
  }
}

class FieldSizes : public testing::TestWithParam<std::size_t> {};

TEST_P(FieldSizes, MatchesTheSimpleLoop) {
  const std::size_t bodies = GetParam();
  const Scene scene = random_scene(bodies, 0.1 * std::cbrt(static_cast<double>(bodies)), 3);
  expect_near(run(scene, {}).wrenches, reference(scene, std::numeric_limits<double>::infinity()),
              1e-11);
  Options options;
  options.max_distance = 0.06;
  expect_near(run(scene, options).wrenches, reference(scene, 0.06), 1e-11);
}

TEST_P(FieldSizes, HasTheSameBitsOnEveryInstructionSet) {
  const std::size_t bodies = GetParam();
  Scene scene = random_scene(bodies, 0.1 * std::cbrt(static_cast<double>(bodies)), 4);
  for (std::size_t i = 0; i < scene.magnets.size(); i += 5) scene.magnets[i].freely_turning = true;
  for (const double max_distance : {0.05, std::numeric_limits<double>::infinity()}) {
    for (const double taper : {0.0, 0.2}) {
      if (std::isinf(max_distance) && taper > 0) continue;
      Options options;
      options.max_distance = max_distance;
      options.taper = taper;
      options.kernel = &baseline_kernel();
      const auto narrow = run(scene, options);
      options.kernel = nullptr;
      expect_same_bits(run(scene, options).wrenches, narrow.wrenches);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bodies, FieldSizes, testing::Values(2, 3, 9, 40));

TEST(Field, HasTheSameBitsWithAnyHistoryOfTheList) {
  Scene scene = random_scene(40, 0.4, 5);
  for (std::size_t i = 0; i < scene.magnets.size(); i += 3) scene.magnets[i].freely_turning = true;
  Options options;
  options.max_distance = 0.05;
  math::RandomStream random(6, "steps");
  std::vector<Vector3> velocities(scene.bodies.size());
  for (auto& velocity : velocities) velocity = random_vector(random, 0.1);
  Field travelled(scene.magnets, scene.bodies.size(), options);
  std::vector<Wrench> wrenches(scene.bodies.size());
  for (int step = 0; step < 60; ++step) {
    const auto turns = std::vector<Quaternion>(travelled.turns().begin(), travelled.turns().end());
    for (std::size_t b = 0; b < velocities.size(); ++b) {
      scene.bodies[b].position += 0.01 * velocities[b];
    }
    travelled.evaluate(0.01, scene.bodies, scene.currents, wrenches);
    Field fresh(scene.magnets, scene.bodies.size(), options);
    fresh.set_turns(turns);
    std::vector<Wrench> again(scene.bodies.size());
    fresh.evaluate(0.01, scene.bodies, scene.currents, again);
    expect_same_bits(wrenches, again);
  }
  EXPECT_GT(travelled.rebuilds(), 5u);
  EXPECT_LT(travelled.rebuilds(), 55u);
}

TEST(Field, AllPairsAndListGiveTheSameBits) {
  Scene scene = random_scene(10, 0.3, 7);
  for (std::size_t i = 0; i < scene.magnets.size(); i += 3) scene.magnets[i].freely_turning = true;
  // A distant magnet enlarges the grid but does not change the results.
  scene.bodies[9].position = {1e9, -1e7, 0};
  Options listed;
  listed.max_distance = 0.07;
  const auto by_list = run(scene, listed);
  // The same range with so many more magnets that all pairs are faster than a list. They have no
  // moment.
  Scene crowded = scene;
  for (int k = 0; k < 800; ++k) {
    Magnet magnet;
    magnet.body = static_cast<std::uint32_t>(crowded.bodies.size());
    crowded.bodies.push_back({});
    crowded.magnets.push_back(magnet);
    crowded.currents.push_back(0);
  }
  const auto by_all = run(crowded, listed);
  expect_same_bits(std::span(by_all.wrenches).first(10), by_list.wrenches);
}

TEST(Field, ConservesMomentumAndAngularMomentumOfTheWhole) {
  const Scene scene = random_scene(30, 0.3, 8);
  for (const double taper : {0.0, 0.3}) {
    Options options;
    options.max_distance = 0.08;
    options.taper = taper;
    const auto wrenches = run(scene, options).wrenches;
    Vector3 force = Vector3::Zero();
    Vector3 torque = Vector3::Zero();
    double scale = 0;
    for (std::size_t b = 0; b < wrenches.size(); ++b) {
      force += wrenches[b].force;
      torque += wrenches[b].torque + scene.bodies[b].position.cross(wrenches[b].force);
      scale += wrenches[b].force.norm();
    }
    EXPECT_LE(force.norm(), 1e-12 * scale);
    EXPECT_LE(torque.norm(), 1e-12 * scale);
  }
}

TEST(Field, CutOffIsInclusiveAndSharp) {
  Scene scene;
  scene.magnets = {{.body = 0, .passive_moment = {0, 0, 1}},
                   {.body = 1, .passive_moment = {0, 0, 1}}};
  scene.bodies = {{}, {{0, 0, 0.5}, Quaternion::Identity()}};
  scene.currents = {0, 0};
  Options options;
  options.max_distance = 0.5;
  EXPECT_NEAR(run(scene, options).wrenches[0].force.z(), 6e-7 / 0.0625, 1e-12);
  scene.bodies[1].position.z() = 0.5000001;
  EXPECT_EQ(run(scene, options).wrenches[0].force.z(), 0);
}

TEST(Field, TaperedForceIsTheGradientOfTheTaperedEnergy) {
  Scene scene = random_scene(2, 0.05, 9);
  scene.bodies[1].position = scene.bodies[0].position + Vector3(0.06, 0.02, 0.01);
  scene.magnets.erase(scene.magnets.begin() + 9, scene.magnets.end());
  scene.magnets.erase(scene.magnets.begin() + 1, scene.magnets.begin() + 8);
  scene.currents.assign(2, 0);
  scene.magnets[0].position = scene.magnets[1].position = Vector3::Zero();
  Options options;
  options.max_distance = 0.08;
  options.taper = 0.5;
  const auto energy = [&](const Vector3& r) {
    const double u = std::clamp((r.norm() - 0.04) / 0.04, 0.0, 1.0);
    const auto moment = [&](int i) -> Vector3 {
      return scene.bodies[i].orientation * scene.magnets[i].passive_moment;
    };
    return (1 - u * u * u * (10 - 15 * u + 6 * u * u)) * dipole_energy(moment(1), moment(0), r);
  };
  const auto wrenches = run(scene, options).wrenches;
  const Vector3 r = scene.bodies[1].position - scene.bodies[0].position;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3 shift = 1e-6 * Vector3::Unit(axis);
    EXPECT_NEAR(wrenches[1].force[axis], (energy(r - shift) - energy(r + shift)) / 2e-6,
                1e-6 * wrenches[1].force.norm());
  }
}

TEST(Field, MagnetsFixedToOneBodyDoNotMoveIt) {
  const Scene scene = random_scene(1, 0.1, 10);
  const auto wrench = run(scene, {}).wrenches[0];
  EXPECT_EQ(wrench.force, Vector3::Zero());
  EXPECT_EQ(wrench.torque, Vector3::Zero());
}

TEST(Field, CurrentsAddTheActiveMoment) {
  Scene scene;
  scene.magnets = {{.body = 0, .passive_moment = {0, 0, 1}},
                   {.body = 1, .passive_moment = {0, 0, 2}, .active_moment = {0, 0, 3}}};
  scene.bodies = {{}, {{0, 0, 0.1}, Quaternion::Identity()}};
  scene.currents = {0, -0.5};
  EXPECT_NEAR(run(scene, {}).wrenches[0].force.z(), 6e-7 * 0.5 / 1e-4, 1e-15);
}

TEST(Field, ExtremePosesCostNeitherTimeNorMemory) {
  Scene scene = random_scene(200, 0.5, 11);
  scene.bodies[3].position.x() = 1e300;
  scene.bodies[4].position.y() = -1e300;
  scene.bodies[5].position.z() = std::nan("");
  Options options;
  options.max_distance = 0.04;
  const auto wrenches = run(scene, options).wrenches;
  EXPECT_TRUE(wrenches[0].force.allFinite());
}

TEST(Field, WorksWithoutMagnets) {
  Field field({}, 1, {});
  std::vector<Wrench> wrenches(1);
  const std::vector<Pose> bodies(1);
  field.evaluate(0.01, bodies, {}, wrenches);
  EXPECT_EQ(wrenches[0].force, Vector3::Zero());
}

TEST(PairSet, OfAllPairsIsTheWholeField) {
  const Scene scene = random_scene(9, 0.2, 5);
  Options options;
  options.max_distance = 0.25;
  Field field(scene.magnets, scene.bodies.size(), options);
  std::vector<Wrench> whole(scene.bodies.size()), pairs(scene.bodies.size());
  field.evaluate(0, scene.bodies, scene.currents, whole);
  std::vector<MagnetPair> listed;
  for (std::uint32_t i = 0; i < scene.magnets.size(); ++i) {
    for (std::uint32_t j = i + 1; j < scene.magnets.size(); ++j) {
      if (scene.magnets[i].body != scene.magnets[j].body) listed.emplace_back(i, j);
    }
  }
  PairSet all;
  all.assign(listed);
  field.evaluate(all, scene.bodies, scene.currents, pairs);
  expect_same_bits(whole, pairs);
}

TEST(PairSet, LeavesTheOtherBodiesAlone) {
  Scene scene = random_scene(4, 0.1, 7);
  Field field(scene.magnets, scene.bodies.size(), {});
  std::vector<Wrench> wrenches(scene.bodies.size());
  field.evaluate(0, scene.bodies, scene.currents, wrenches);
  const Wrench before = wrenches[0];
  std::uint32_t first = 0, second = 0;
  while (scene.magnets[first].body != 1) ++first;
  while (scene.magnets[second].body != 2) ++second;
  PairSet pairs;
  pairs.assign(std::vector<MagnetPair>{{first, second}});
  scene.bodies[1].position.x() += 0.01;
  field.evaluate(pairs, scene.bodies, scene.currents, wrenches);
  EXPECT_EQ(wrenches[0].force, before.force);
  EXPECT_EQ(wrenches[1].force, -wrenches[2].force);
  const auto moment = [&](std::uint32_t i) -> Vector3 {
    const Magnet& m = scene.magnets[i];
    return scene.bodies[m.body].orientation *
           (m.passive_moment + scene.currents[i] * m.active_moment);
  };
  const auto at = [&](std::uint32_t i) {
    return scene.bodies[scene.magnets[i].body] * scene.magnets[i].position;
  };
  const auto expected = dipole_pair(moment(first), moment(second), at(first) - at(second));
  EXPECT_LT((wrenches[1].force - expected.force_on_first).norm(),
            1e-11 * expected.force_on_first.norm());
}

TEST(Core, BoundsTheForceOfMagnetsInsideEachOther) {
  std::vector<Magnet> magnets(2);
  for (std::uint32_t i = 0; i < 2; ++i) {
    magnets[i].body = i;
    magnets[i].passive_moment = {0, 0, 1};
    magnets[i].core = 4e-3;
  }
  for (const double distance : {1e-3, 7e-3, 9e-3}) {
    Field field(magnets, 2, {});
    const std::vector<Pose> poses{{{0, 0, 0}, Quaternion::Identity()},
                                  {{0, 0, distance}, Quaternion::Identity()}};
    std::vector<Wrench> wrenches(2);
    field.evaluate(0, poses, std::vector<double>(2), wrenches);
    const auto expected = dipole_pair({0, 0, 1}, {0, 0, 1}, {0, 0, -distance}, 8e-3);
    EXPECT_NEAR(wrenches[0].force.z(), expected.force_on_first.z(),
                1e-12 * expected.force_on_first.norm());
    EXPECT_LE(wrenches[0].force.norm(), 6e-7 / std::pow(8e-3, 4) * (1 + 1e-12));
  }
}

}  // namespace
}  // namespace ziggurat::magnetism
