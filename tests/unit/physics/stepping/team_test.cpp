// SPDX-License-Identifier: MIT
// A team's threads share loops; a step has the same bits for any number of threads.

#include "physics/stepping/team.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "physics/stepping/system.h"

namespace ziggurat::dynamics {
namespace {

TEST(Team, TakesEachItemOnce) {
  for (const unsigned threads : {1U, 2U, 5U}) {
    Team team(threads);
    EXPECT_EQ(team.size(), threads);
    for (std::size_t count = 0; count < 300; ++count) {
      std::vector<int> taken(count);
      team.share(count, [&](std::size_t item, unsigned member) {
        ASSERT_LT(member, threads);
        ++taken[item];
      });
      EXPECT_EQ(taken, std::vector<int>(count, 1));
    }
  }
}

TEST(Team, PassesAnExceptionOn) {
  Team team(3);
  const auto fail = [](std::size_t item, unsigned) {
    if (item == 40) throw std::runtime_error("of an item");
  };
  EXPECT_THROW(team.share(100, fail), std::runtime_error);
  int last = -1;
  team.share(1, [&](std::size_t item, unsigned) { last = static_cast<int>(item); });
  EXPECT_EQ(last, 0);
}

/// Balls of different masses in fifty groups: each but the first of a group pushes the one before
/// it, so that groups of one to seven balls are islands.
struct Groups {
  System system;
  std::vector<ContactPoint> contacts;

  explicit Groups(unsigned threads) {
    system.set_threads(threads);
    for (int group = 0; group < 50; ++group) {
      for (int ball = 0; ball <= group % 7; ++ball) add(group, ball);
    }
  }
  void add(int group, int ball) {
    Link link;
    link.mass = 0.1 + 0.02 * group;
    link.inertia = Vector3(1e-4, 2e-4, 1e-4 + 1e-6 * group);
    const int number = static_cast<int>(system.trees.size());
    system.trees.emplace_back(std::vector<Link>{link},
                              math::Pose{Vector3(0.1 * ball, group, 0), Quaternion::Identity()});
    Tree& tree = system.trees.back();
    tree.gravity = Vector3(0, 0, -9.8);
    tree.v[3] = -0.3 * ball, tree.v[2] = 3;
    velocity_kinematics(tree);
    ContactPoint floor;
    floor.a.tree = number;
    floor.point = Vector3(0.1 * ball, group, -0.05);
    floor.friction = 0.4;
    contacts.push_back(floor);
    if (ball == 0) return;
    ContactPoint touch = floor;
    touch.b.tree = number - 1;
    touch.point = Vector3(0.1 * ball - 0.05, group, 0);
    touch.normal = Vector3::UnitX();
    contacts.push_back(touch);
  }
  std::vector<double> run() {
    std::vector<double> state;
    for (int step = 0; step < 5; ++step) {
      const Report report = system.step(0.01, contacts);
      state.push_back(report.residual);
      state.push_back(report.islands);
    }
    for (const Tree& tree : system.trees) {
      state.insert(state.end(), tree.q.begin(), tree.q.end());
      state.insert(state.end(), tree.v.begin(), tree.v.end());
    }
    return state;
  }
};

TEST(Threads, ChangeNoBit) {
  const std::vector<double> alone = Groups(1).run();
  for (const unsigned threads : {2U, 3U, 8U}) EXPECT_EQ(Groups(threads).run(), alone) << threads;
}

TEST(Threads, HaveTheSameOptions) {
  Groups groups(4);
  groups.system.solver().options.most_factorisation_work = 0;  // passes only
  Groups alone(1);
  alone.system.solver().options.most_factorisation_work = 0;
  EXPECT_EQ(groups.run(), alone.run());
}

}  // namespace
}  // namespace ziggurat::dynamics
