// SPDX-License-Identifier: MIT
// A world that was put back goes on as the one that was never interrupted: every scene, at random
// ticks, under random commands. Finds what a snapshot forgets, and names the field.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "../long_runs.h"
#include "checkout/checkout.h"
#include "math/random.h"
#include "scene/reader.h"
#include "simulation/simulation.h"

namespace ziggurat::simulation {
namespace {

/// Commands that are a function of the tick alone, so that a world that was put back gets the same.
class RandomCommands {
 public:
  void set(Simulation& simulation) const {
    const std::uint64_t tick = simulation.state().tick;
    math::RandomStream random(7, "commands/" + std::to_string(tick));
    world::Commands& commands = simulation.commands();
    if (tick % 5 == 0) set_motors(random, commands);
    if (tick % 7 == 0) set_lights(random, commands);
    send(random, simulation.layout(), commands);
  }

 private:
  static void set_motors(math::RandomStream& random, world::Commands& commands) {
    for (double& target : commands.joint_targets) target = random.uniform(-1, 1);
    for (double& current : commands.magnet_currents) current = random.uniform(-1, 1);
    for (world::WheelsCommand& wheels : commands.wheels) {
      wheels = {random.uniform(-0.1, 0.2), random.uniform(-0.1, 0.2)};
    }
    for (world::TurretMode& mode : commands.turret_modes) {
      mode = static_cast<world::TurretMode>(random.uniform(0, 2.99));
    }
    for (double& rotation : commands.turret_rotations) rotation = random.uniform(-3, 3);
    for (double& speed : commands.turret_speeds) speed = random.uniform(-3, 3);
  }

  static void set_lights(math::RandomStream& random, world::Commands& commands) {
    const auto color = [&] { return static_cast<world::Color>(random.uniform(0, 0xFFFFFF)); };
    std::ranges::generate(commands.led_colors, color);
    std::ranges::generate(commands.directional_led_colors, color);
    for (std::string& payload : commands.tag_payloads) payload = std::to_string(color());
    for (auto& byte : commands.range_and_bearing_data) {
      byte = static_cast<std::uint8_t>(random.uniform(0, 255));
    }
  }

  static void send(math::RandomStream& random, const world::Layout& layout,
                   world::Commands& commands) {
    for (std::size_t i = 0; i < layout.radios.size(); ++i) {
      if (!layout.radios[i].sends || random.uniform(0, 1) < 0.7) continue;
      const std::uint8_t bytes[] = {static_cast<std::uint8_t>(i),
                                    static_cast<std::uint8_t>(random.uniform(0, 255))};
      commands.radio_messages.add(i, bytes);
    }
  }
};

std::vector<std::filesystem::path> scenes() {
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(checkout() / "scenes")) {
    const bool is_part = entry.path().parent_path().filename() == "models";  // of other scenes
    if (entry.is_symlink()) continue;                                        // a second name
    if (entry.path().extension() == ".argos" && !is_part) found.push_back(entry.path());
  }
  std::ranges::sort(found);
  return found;
}

class Futures : public ::testing::TestWithParam<std::filesystem::path> {
 protected:
  /// Values that are compared.
  struct Extent {
    std::uint64_t moments, after;  // [ticks]
    double latest;                 // moment [ticks]
  };

  void compare(const scene::Scene& scene, const Extent& extent) const;

  /// One tick. Messages are sent once, so a snapshot has them if they are set before it.
  void step(Simulation& simulation) const {
    simulation.step();
    commands_.set(simulation);
  }

  RandomCommands commands_;
};

void Futures::compare(const scene::Scene& scene, const Extent& extent) const {
  const std::uint64_t moments = extent.moments, after = extent.after;
  const double latest = extent.latest;
  math::RandomStream random(3, GetParam().filename().string());
  std::map<std::uint64_t, Snapshot> snapshots;
  while (snapshots.size() < moments)
    snapshots[static_cast<std::uint64_t>(random.uniform(0, latest))];
  const std::uint64_t last = snapshots.rbegin()->first + after;

  Simulation simulation(scene, {7});
  commands_.set(simulation);
  std::vector<std::uint64_t> hashes;
  std::map<std::uint64_t, Snapshot> ends;
  for (;; step(simulation)) {
    const std::uint64_t tick = simulation.state().tick;
    hashes.push_back(simulation.hash());
    if (const auto found = snapshots.find(tick); found != snapshots.end()) {
      found->second = simulation.snapshot();
      ASSERT_EQ(simulation.first_difference(found->second), "");
    }
    if (tick >= after && snapshots.contains(tick - after)) ends[tick] = simulation.snapshot();
    if (tick == last) break;
  }

  const auto expect_future = [&](Simulation& world, const Snapshot& snapshot, const char* which) {
    ASSERT_EQ(world.state().tick, snapshot.tick) << which;
    ASSERT_EQ(world.first_difference(snapshot), "") << which << ", at once";
    while (world.state().tick < snapshot.tick + after) {
      step(world);
      const std::uint64_t tick = world.state().tick;
      ASSERT_EQ(world.hash(), hashes[tick])
          << which << ": restored at tick " << snapshot.tick << ", differs at tick " << tick;
    }
    EXPECT_EQ(world.first_difference(ends[world.state().tick]), "")
        << which << ": restored at tick " << snapshot.tick;
  };
  for (const auto& [tick, snapshot] : snapshots) {
    simulation.restore(scene, snapshot);
    ASSERT_NO_FATAL_FAILURE(expect_future(simulation, snapshot, "the same simulation"));
  }
  // A fresh world, once at the first moment and once at the last.
  for (const Snapshot* snapshot : {&snapshots.begin()->second, &snapshots.rbegin()->second}) {
    Snapshot copy = *snapshot;
    copy.is_checked = false;  // as if it was read from a file: a new world is built for it
    Simulation fresh(scene, {11});
    fresh.restore(scene, copy);
    ASSERT_NO_FATAL_FAILURE(expect_future(fresh, *snapshot, "a fresh simulation"));
  }
}

TEST_P(Futures, AreThoseOfAWorldThatWasNeverInterrupted) {
  const scene::ReadResult read = scene::read_file(GetParam());
  ASSERT_TRUE(read.ok());
  const Extent all{10, 50, 100}, some{4, 20, 60}, few{2, 5, 20};
  compare(read.scene, long_runs::is_slow ? few : long_runs::takes_all() ? all : some);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Futures, ::testing::ValuesIn(scenes()), [](const auto& scene) {
  std::string name = (scene.param.parent_path().filename() / scene.param.stem()).string();
  std::ranges::replace_if(
      name, [](char c) { return c == '-' || c == '.' || c == '/'; }, '_');
  return name;
});

}  // namespace
}  // namespace ziggurat::simulation
