// SPDX-License-Identifier: MIT
// Islands that are kept from step to step are those that are built anew.

#include "physics/stepping/islands.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "trees.h"

namespace ziggurat::dynamics {
namespace {

bool are_alike(const IslandItem& a, const IslandItem& b) {
  return a.island == b.island && a.kind == b.kind && a.index == b.index;
}

void expect_same(const Islands& kept, const Islands& anew) {
  EXPECT_EQ(kept.trees, anew.trees);
  EXPECT_EQ(kept.first_tree, anew.first_tree);
  EXPECT_EQ(kept.first_item, anew.first_item);
  EXPECT_TRUE(std::ranges::equal(kept.items, anew.items, are_alike));
}

/// Moves one side of a contact to another tree, or to the world.
void change_one(std::vector<ContactPoint>& contacts, int trees, std::mt19937& random) {
  ContactPoint& contact = contacts[random() % contacts.size()];
  LinkIndex& side = random() % 2 == 0 ? contact.a : contact.b;
  side.tree = static_cast<int>(random() % static_cast<unsigned>(trees + 1)) - 1;
}

TEST(Islands, ThatStayAreThoseThatAreBuiltAnew) {
  constexpr int count = 6;
  std::mt19937 random(1);
  const std::vector<Tree> trees(count, testing::box(Vector3::Constant(0.1), 1, {}));
  Sleep sleep;
  sleep.ring.assign(count, -1);
  Islands kept;
  std::vector<ContactPoint> contacts(5);
  for (int step = 0; step < 400; ++step) {
    if (random() % 2 == 0) change_one(contacts, count, random);
    contacts[random() % contacts.size()].point.x() = static_cast<double>(random() % 3);
    const int changed = static_cast<int>(random() % count);
    if (random() % 4 == 0) {
      sleep.ring[changed] = sleep.is_asleep(changed) ? -1 : changed;
      ++sleep.changes;
    }
    std::vector<int> awake;
    for (int i = 0; i < count; ++i) {
      if (!sleep.is_asleep(i)) awake.push_back(i);
    }
    std::vector<Servo> servos(random() % 2);
    for (Servo& servo : servos) servo.tree = changed;
    ConstraintLists constraints{contacts, servos, {}, {}};
    list_contact_trees(contacts, constraints.contact_trees);
    Islands anew;
    for (Islands* islands : {&kept, &anew}) {
      build_islands(trees, sleep, awake, constraints, *islands);
      for (std::size_t i = 0; i < islands->size(); ++i) sort_items(*islands, i, contacts);
    }
    expect_same(kept, anew);
  }
}

}  // namespace
}  // namespace ziggurat::dynamics
