// SPDX-License-Identifier: MIT
// A spawn that fails at any point leaves the world as it was: each allocation is made to fail once.

#include <gtest/gtest.h>

#include <new>

#include "allocations/allocations.h"
#include "small_scene.h"

namespace ziggurat::simulation {
namespace {

using testing::robot;
using testing::SmallScene;

/// A robot with a joint, a radio, an LED, a tag, a magnet and a ray along +y.
std::string equipped(const std::string& id, const std::string& position) {
  return "<prototype id=\"" + id + "\"><body position=\"" + position +
         R"("/><links ref="base"><link id="base" geometry="box" size=".1,.1,.1" mass="1"/>)"
         R"(<link id="arm" geometry="hull" mass="0.1"><hull><vertex position="0,0,0"/>)"
         R"(<vertex position="0.05,0,0"/><vertex position="0,0.05,0"/>)"
         R"(<vertex position="0,0,0.1"/></hull></link></links><joints>)"
         R"(<joint id="hinge" type="revolute" axis="0,0,1" limit="-90:90">)"
         R"(<parent link="base" position="0,0,0.11"/><child link="arm"/></joint></joints><devices>)"
         R"(<radios medium="air"><radio anchor="base" position="0,0,0" range="1"/></radios>)"
         R"(<leds medium="leds"><led anchor="base" offset="0,0,0.1" color="red"/></leds>)"
         R"(<tags medium="tags"><tag anchor="base" position="0,0,0.1" orientation="0,0,0" )"
         R"(observable_angle="90" side_length="0.05" payload="too long for a small string"/>)"
         R"(</tags><proximity_sensors><sensor anchor="base" offset="0,0,0.05" direction="0,1,0" )"
         R"(range="2"/></proximity_sensors><magnets><magnet anchor="base" offset="0,0,0" passive_field="0,0,1"/></magnets>)"
         R"(</devices><controller config="c"/></prototype>)";
}

const std::string bodies =
    R"(<box id="low" size=".1,.1,.1" mass="1" movable="true"><body position="0.4,0,0"/></box>)"
    R"(<box id="high" size=".1,.1,.1" mass="1" movable="true"><body position="0.4,0,0.1"/></box>)"
    R"(<sphere id="ball" radius="0.05" mass="1" movable="true"><body position="0.8,0,0"/></sphere>)";

const std::string engine = R"(<floor/><gravity g="9.8"/><magnetism/>)";

const SmallScene robots{
    R"(<joints implementation="default"><joint id="hinge" mode="position" max_impulse="1"/></joints>)"
    R"(<radios implementation="default"/><leds implementation="default" medium="leds"/>)"
    R"(<tags implementation="default"/>)",
    R"(<joints implementation="default"><joint id="hinge" mode="position"/></joints>)"
    R"(<radios implementation="default"/><positioning implementation="default"/>)"
    R"(<proximity implementation="default"/>)",
    equipped("first", "0,0,0") + bodies, engine};

/// The controller's camera takes pictures, and nothing in the scene has one.
const SmallScene cameras{
    "",
    R"(<cameras implementation="default"><camera id="eye" anchor="base" position="0,0,0.2" )"
    R"(orientation="0,0,0" range="0.1:1" focal_length="100,100" resolution="64,48" )"
    R"(principle_point="32,24" image="true"/></cameras>)",
    bodies, engine};

struct Numbers {
  std::size_t entities, links, robots, radios, leds, tags, commanded_leds, positions;
  std::uint64_t hash;
  bool operator==(const Numbers&) const = default;
};

Numbers numbers(Simulation& simulation) {
  const world::Layout& layout = simulation.layout();
  return {layout.entities.size(),
          layout.links.size(),
          layout.robots.size(),
          layout.radios.size(),
          layout.leds.size(),
          layout.tags.size(),
          simulation.commands().led_colors.size(),
          simulation.observations().positioning.size(),
          simulation.hash()};
}

/// A world, and another that no failing spawn has touched.
struct Twins {
  explicit Twins(const SmallScene& small) : read(small.read_all()) {}

  scene::Entity entity(const std::string& xml) const {
    const scene::Addition addition = read.additions.read(xml, read.scene, std::size_t{1} << 20,
                                                         [](const std::string&) { return false; });
    for (const auto& problem : addition.problems) ADD_FAILURE() << scene::to_string(problem);
    return addition.entity;
  }
  void step(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      world.step();
      untouched.step();
      ASSERT_EQ(world.hash(), untouched.hash()) << "tick " << i;
    }
  }

  scene::ReadResult read;
  Simulation world{read.scene, {1}};
  Simulation untouched{read.scene, {1}};
};

/// @param failing  the allocation that fails
/// @returns whether the entity was spawned
bool spawn(Simulation& world, const scene::Scene& scene, const scene::Entity& entity,
           std::size_t failing) {
  const ziggurat::testing::FailingAllocation out_of_memory(failing);
  try {
    world.spawn(scene, entity);
    return true;
  } catch (const std::bad_alloc&) {
    return false;
  }
}

/// The same for a reset to seed 7.
bool reset(Simulation& world, const scene::Scene& scene, std::size_t failing) {
  const ziggurat::testing::FailingAllocation out_of_memory(failing);
  try {
    world.reset(scene, {7});
    return true;
  } catch (const std::bad_alloc&) {
    return false;
  }
}

TEST(FailingSpawn, OutOfMemoryAnywhereChangesNothing) {
  Twins twins(robots);
  const scene::Entity entity = twins.entity(equipped("second", "0,1,0"));
  twins.step(3);
  std::size_t stages = 0;
  for (Numbers before = numbers(twins.world); !spawn(twins.world, twins.read.scene, entity, stages);
       ++stages) {
    ASSERT_EQ(numbers(twins.world), before) << "allocation " << stages;
    ASSERT_LT(stages, 100'000u);
    if (stages % 50 != 0) continue;
    twins.step(1);
    before = numbers(twins.world);
  }
  EXPECT_GT(stages, 100u);
  twins.untouched.spawn(twins.read.scene, entity);
  twins.step(20);
  EXPECT_GT(twins.world.observations().proximity.at(0), 0);  // the first robot's ray meets it
}

TEST(FailingSpawn, OutOfMemoryOfTheFirstPicturesChangesNothing) {
  Twins twins(cameras);
  twins.step(3);
  const scene::Entity entity = twins.entity(equipped("eye", "2,0,0"));
  const Numbers before = numbers(twins.world);
  std::size_t stages = 0;
  for (; !spawn(twins.world, twins.read.scene, entity, stages); ++stages) {
    ASSERT_EQ(numbers(twins.world), before) << "allocation " << stages;
    ASSERT_LT(stages, 100'000u);
  }
  EXPECT_GT(stages, 100u);
  twins.untouched.spawn(twins.read.scene, entity);
  twins.step(2);
}

TEST(FailingSpawn, AResetOutOfMemoryAnywhereChangesNothing) {
  Twins twins(robots);
  twins.step(2);
  const Numbers before = numbers(twins.world);
  std::size_t stages = 0;
  for (; !reset(twins.world, twins.read.scene, stages); ++stages) {
    ASSERT_EQ(numbers(twins.world), before) << "allocation " << stages;
    ASSERT_LT(stages, 100'000u);
  }
  EXPECT_GT(stages, 100u);
  twins.untouched.reset(twins.read.scene, {7});
  twins.step(3);
}

}  // namespace
}  // namespace ziggurat::simulation
