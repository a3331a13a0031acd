// SPDX-License-Identifier: MIT
// Snapshots: state beyond a scene's own entities, files, and bytes of others.

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <stdexcept>

#include "math/archive.h"
#include "small_scene.h"
#include "words_of.h"

namespace ziggurat::simulation {
namespace {

using testing::ground;
using testing::robot;
using testing::SmallScene;

std::string loose_box(const std::string& id, const std::string& position) {
  return R"(<box id=")" + id + R"(" size=".1,.1,.1" movable="true" mass="1"><body position=")" +
         position + R"("/></box>)";
}

struct Case {
  Case()
      : read(SmallScene{
            "", "",
            loose_box("a", "0,0,.3") + loose_box("b", ".02,0,.5") + robot("r", "1,0,.1", ""),
            ground}
                 .read_all()),
        simulation(read.scene, {1}) {}

  scene::Entity entity(const std::string& xml) const {
    scene::Addition addition =
        read.additions.read(xml, read.scene, 1 << 20, [](const std::string&) { return false; });
    if (!addition.ok()) throw scene::SceneError(std::move(addition.problems));
    return std::move(addition.entity);
  }
  void spawn(const std::string& id, const std::string& position) {
    const std::string xml = loose_box(id, position);
    simulation.spawn(read.scene, entity(xml), xml);
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) simulation.step();
  }
  std::vector<std::uint64_t> future(int ticks) {
    std::vector<std::uint64_t> hashes;
    for (int i = 0; i < ticks; ++i) {
      simulation.step();
      hashes.push_back(simulation.hash());
    }
    return hashes;
  }
  /// A past with everything that supervisors can do.
  void live() {
    run(3);
    spawn("c", "0,0,.9");
    run(2);
    simulation.remove(simulation.layout().entities.size() - 1);
    spawn("d", "0,0,.7");
    run(4);
    simulation.move(0, {math::Vector3(1, 1, 0.4), math::Quaternion::Identity()});
    run(1);
    simulation.remove(1);
    spawn("e", "2,0,.3");
    simulation.move(0, {math::Vector3(1, 1, 0.2), math::Quaternion::Identity()});
  }

  scene::ReadResult read;
  Simulation simulation;
};

TEST(Snapshot, CarryWhatCameAndWentAndWasMoved) {
  Case world;
  world.live();
  const Snapshot snapshot = world.simulation.snapshot();
  const auto expected = world.future(30);
  const world::Layout* layout = &world.simulation.layout();
  world.simulation.restore(world.read.scene, snapshot);
  EXPECT_EQ(&world.simulation.layout(), layout) << "others keep references to it";
  EXPECT_EQ(world.simulation.hash(), snapshot.hash);
  EXPECT_EQ(world.future(30), expected);
}

TEST(Snapshot, TakeBackWhatCameAndWentSince) {
  Case world;
  world.live();
  const Snapshot snapshot = world.simulation.snapshot();
  const auto expected = world.future(30);
  world.simulation.remove(0);
  world.spawn("f", "3,0,.3");
  world.run(5);
  world.simulation.restore(world.read.scene, snapshot);
  EXPECT_EQ(world.future(30), expected);
  world.simulation.reset(world.read.scene, {5, {}});
  world.simulation.restore(world.read.scene, snapshot);
  EXPECT_EQ(world.future(30), expected);
}

TEST(Snapshot, GoThroughAFile) {
  Case world;
  world.live();
  const Snapshot snapshot = world.simulation.snapshot();
  const std::vector<std::byte> bytes = to_bytes(snapshot, {"scene", "build"});
  const auto expected = world.future(30);
  Case other;
  const auto read = [&](const std::string& xml) { return other.entity(xml); };
  other.simulation.restore(other.read.scene, from_bytes(bytes, {"scene", "build"}, read));
  EXPECT_EQ(other.simulation.hash(), snapshot.hash);
  EXPECT_EQ(other.future(30), expected);
  EXPECT_THROW(from_bytes(bytes, {"other", "build"}, read), SnapshotError);
  EXPECT_THROW(from_bytes(bytes, {"scene", "other"}, read), SnapshotError);
}

TEST(Snapshot, OfAFileThatIsDamagedAreRefused) {
  Case world;
  world.live();
  const std::vector<std::byte> bytes = to_bytes(world.simulation.snapshot(), {"scene", "build"});
  const auto read = [&](const std::string& xml) { return world.entity(xml); };
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    std::vector<std::byte> damaged = bytes;
    damaged[random() % damaged.size()] ^= static_cast<std::byte>(1U << random() % 8);
    EXPECT_THROW(from_bytes(damaged, {"scene", "build"}, read), SnapshotError);
    damaged.resize(random() % bytes.size());
    EXPECT_THROW(from_bytes(damaged, {"scene", "build"}, read), SnapshotError);
  }
  for (std::size_t size = 0; size < 60; ++size) {  // cut off in the mark, too
    EXPECT_THROW(from_bytes(std::span(bytes).first(size), {"scene", "build"}, read), SnapshotError);
  }
}

TEST(Snapshot, ListTheContactsOfTheirLastSubstep) {
  Case world, other;
  world.simulation.list_contacts(true);
  world.run(20);
  const std::vector<world::Contact> expected = world.simulation.contacts();
  ASSERT_FALSE(expected.empty());
  const Snapshot snapshot = world.simulation.snapshot();
  other.simulation.list_contacts(true);
  for (Case* each : {&world, &other}) {
    each->run(3);
    each->simulation.restore(each->read.scene, snapshot);
    const std::vector<world::Contact>& listed = each->simulation.contacts();
    ASSERT_EQ(listed.size(), expected.size());
    for (std::size_t i = 0; i < listed.size(); ++i) {
      EXPECT_EQ(listed[i].link, expected[i].link);
      EXPECT_EQ(listed[i].other, expected[i].other);
      EXPECT_EQ(listed[i].point, expected[i].point);
      EXPECT_EQ(listed[i].force, expected[i].force);
    }
  }
}

TEST(Snapshot, CarryPushesThatAreTheSameAtEachTick) {
  Case world;
  const auto push = [&](int ticks) {
    for (int i = 0; i < ticks; ++i) {
      world.simulation.commands().pushes.push_back({0, {3, 0, 1}, {0, 0, 0}});
      world.simulation.step();
    }
    return world.simulation.hash();
  };
  push(5);
  const Snapshot snapshot = world.simulation.snapshot();
  const std::uint64_t expected = push(5);
  world.spawn("c", "5,0,.9");  // so that the world is built again
  world.simulation.restore(world.read.scene, snapshot);
  EXPECT_EQ(push(5), expected);
}

/// The state's own checks hold past the checksum: with any bytes the world is restored to some
/// state or stays as it is, and goes on.
TEST(Snapshot, OfWrongStateLeavesTheWorldAsItIs) {
  Case world;
  world.live();
  const Snapshot snapshot = world.simulation.snapshot();
  std::mt19937_64 random(1);
  int refused = 0;
  for (int i = 0; i < 600; ++i) {
    Snapshot wrong = snapshot;
    wrong.is_checked = false;
    if (i % 6 == 0) {
      wrong.state.resize(random() % wrong.state.size());
    } else {
      // The low bytes are those of numbers, high ones those of sizes and exponents.
      for (std::size_t k = 0; k <= static_cast<std::size_t>(i % 3); ++k) {
        wrong.state[random() % wrong.state.size()] = static_cast<std::byte>(random());
      }
    }
    const std::uint64_t before = world.simulation.hash();
    try {
      world.simulation.restore(world.read.scene, wrong);
    } catch (const SnapshotError&) {
      ++refused;
      ASSERT_EQ(world.simulation.hash(), before);
    }
    try {
      world.simulation.step();
    } catch (const std::runtime_error&) {  // the state is no longer finite
      world.simulation.restore(world.read.scene, snapshot);
    }
  }
  EXPECT_GT(refused, 100);
}

/// Position of a field in the state of a world that is as in the snapshot.
std::size_t place_of(const Simulation& world, const Snapshot& snapshot, const std::string& field) {
  Snapshot other = snapshot;
  for (std::size_t i = 0; i < other.state.size(); ++i) {
    other.state[i] ^= std::byte{1};
    if (world.first_difference(other) == field) return i;
    other.state[i] ^= std::byte{1};
  }
  throw std::logic_error("there is no " + field);
}

/// Pairs that are no more take a byte each, and a thousand times as much memory.
TEST(Snapshot, WithMorePairsThanTheWorldCanHaveIsRefused) {
  Case world;
  world.run(20);
  Snapshot wrong = world.simulation.snapshot();
  wrong.is_checked = false;
  const std::size_t at = place_of(world.simulation, wrong, "physics/core/contacts/pairs");
  std::uint64_t pairs = 0;
  std::memcpy(&pairs, &wrong.state[at], sizeof pairs);
  constexpr std::uint64_t more = 100;
  pairs += more;
  std::memcpy(&wrong.state[at], &pairs, sizeof pairs);
  wrong.state.insert(wrong.state.begin() + static_cast<std::ptrdiff_t>(at + sizeof pairs), more,
                     {});
  EXPECT_TRUE(fails_with<SnapshotError>("contacts/pairs' has more elements", [&] {
    world.simulation.restore(world.read.scene, wrong);
  }));
}

/// A list is as long as its bytes, whatever its length says.
TEST(Snapshot, TakesNoMemoryForElementsThatAreNotThere) {
  const auto memory_for = [](std::uint64_t count) {
    std::vector<std::byte> bytes(sizeof count + 1000);
    std::memcpy(bytes.data(), &count, sizeof count);
    std::vector<WorldEdit> read;
    auto archive = math::Archive::reader(bytes);
    EXPECT_THROW(archive.list("acts", read, [&](WorldEdit& each) { archive("xml", each.xml); }),
                 math::ArchiveError);
    return read.capacity();
  };
  EXPECT_LE(memory_for(1000), 256u) << "each has eight bytes";
  EXPECT_EQ(memory_for(1001), 0u);
}

TEST(Snapshot, NamesTheFieldThatDiffers) {
  Case world;
  world.run(3);
  const Snapshot snapshot = world.simulation.snapshot();
  EXPECT_EQ(world.simulation.first_difference(snapshot), "");
  world.run(1);
  EXPECT_NE(world.simulation.first_difference(snapshot), "");
}

}  // namespace
}  // namespace ziggurat::simulation
