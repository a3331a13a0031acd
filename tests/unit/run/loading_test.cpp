// SPDX-License-Identifier: MIT
#include "run/loading.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "processes/private_folder.h"
#include "simulation/simulation.h"
#include "supervision/world.h"
#include "text/numbers.h"

namespace ziggurat::run {
namespace {

scene::Scene scene_of(double length, unsigned ticks_per_second) {
  scene::Scene scene;
  scene.experiment.length = length;
  scene.experiment.ticks_per_second = ticks_per_second;
  return scene;
}

TEST(TickCount, IsTheLengthInTicks) {
  EXPECT_EQ(tick_count({}, scene_of(60, 5)), 300u);
  EXPECT_EQ(tick_count({}, scene_of(0.25, 10)), 2u) << "an incomplete tick is left out";
  EXPECT_EQ(tick_count({}, scene_of(0.29, 100)), 29u) << "though the product is 28.999999999999996";
  EXPECT_EQ(tick_count({}, scene_of(0, 10)), std::nullopt) << "until it is stopped";
}

TEST(TickCount, CommandLineWins) {
  Options ticks, duration, endless;
  ticks.ticks = 0;
  duration.duration = 2;
  endless.duration = 0;
  EXPECT_EQ(tick_count(ticks, scene_of(60, 5)), 0u);
  EXPECT_EQ(tick_count(duration, scene_of(60, 5)), 10u);
  EXPECT_EQ(tick_count(endless, scene_of(60, 5)), std::nullopt);
}

TEST(TickCount, ExtremesAreNoSurprise) {
  EXPECT_THROW(tick_count({}, scene_of(0.001, 10)), text::UsageError);
  EXPECT_EQ(tick_count({}, scene_of(1e300, 10)), std::uint64_t{1} << 63);
}

TEST(Seed, CommandLineWinsAndZeroDrawsOne) {
  auto scene = scene_of(1, 1);
  scene.experiment.random_seed = 5;
  Options options;
  EXPECT_EQ(choose_seed(options, scene.experiment.random_seed), 5u);
  options.seed = 9;
  EXPECT_EQ(choose_seed(options, scene.experiment.random_seed), 9u);
  options.seed = 0;
  const auto first = choose_seed(options, scene.experiment.random_seed);
  EXPECT_NE(first, 0u);
  EXPECT_TRUE(choose_seed(options, scene.experiment.random_seed) != first ||
              choose_seed(options, scene.experiment.random_seed) != first);
}

class Included : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const {
    const std::filesystem::path path = std::filesystem::path(folder_.path()) / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }
  void SetUp() override {
    write("parts/block.argos", block("block.lua"));
    write("parts/block.lua", "");
    write("scenes/own.lua", "");
    write("scenes/a.argos",
          R"(<a><include file="../parts/block.argos"/>
<framework><experiment ticks_per_second="10"/></framework><controllers/><media/>
<physics_engines><dynamics3d id="d"/></physics_engines><arena size="9,9,9">
<prototype id="a" model="block"><body/></prototype>
<prototype id="b" model="block"><body position="3,0,0"/>
<controller config="c"><params script="own.lua"/></controller></prototype>
<distribute><position method="grid" center="0,5,0" distances="2,2,2" layout="2,1,1"/>
<orientation method="constant" values="0,0,0"/>
<entity quantity="2" max_trials="1"><prototype id="d" model="block"/></entity></distribute>
</arena></a>)");
  }
  static std::string block(const std::string& script) {
    return R"(<m><controllers><lua_controller id="c"><actuators/><sensors/><params script=")" +
           script + R"("/></lua_controller></controllers><models><prototype id="block">
<links ref="l"><link id="l" geometry="sphere" radius="0.1" mass="1"/></links>
<controller config="c"/></prototype></models></m>)";
  }
  processes::PrivateFolder folder_;
};

TEST_F(Included, ScriptsAreFoundBesideTheFileThatNamesThem) {
  const std::string path = folder_.path() + "/scenes/a.argos";
  reports::Console console({true, false});
  const auto scene = load_scene(path, {}, console).scene;
  const simulation::Simulation simulation(scene, {1});
  const std::string block_script = folder_.path() + "/parts/block.lua";
  EXPECT_EQ(script_paths(scene, simulation.layout(), path),
            (std::vector<std::string>{block_script, folder_.path() + "/scenes/own.lua",
                                      block_script, block_script}));
}

TEST_F(Included, FilesAreInTheHashOfTheScene) {
  const std::string path = folder_.path() + "/scenes/a.argos";
  reports::Console console({true, false});
  const auto before = supervision::scene_hash(load_scene(path, {}, console).scene);
  EXPECT_EQ(supervision::scene_hash(load_scene(path, {}, console).scene), before);
  write("parts/block.argos", block("./block.lua"));
  EXPECT_NE(supervision::scene_hash(load_scene(path, {}, console).scene), before);
}

}  // namespace
}  // namespace ziggurat::run
