// SPDX-License-Identifier: MIT
#include "processes/controllers.h"

#include <gtest/gtest.h>

#include "words_of.h"

namespace ziggurat::processes {
namespace {

struct World {
  scene::Scene scene;
  world::Layout layout;
  std::vector<std::string> scripts;
};

// Controller 0 is Lua, 1 has a command, 2 has neither. There is one robot for each number.
World world_of(const std::vector<std::size_t>& controllers) {
  World world;
  world.scene.controllers.resize(3);
  world.scene.controllers[0].lua = true;
  world.scene.controllers[1].id = "drive";
  world.scene.controllers[1].command = "./drive --fast";
  for (std::size_t r = 0; r < controllers.size(); ++r) {
    auto& robot = world.layout.robots.emplace_back();
    robot.id = "r" + std::to_string(r);
    robot.controller = controllers[r];
    world.scripts.push_back(controllers[r] == 0 ? "/script.lua" : "");
  }
  return world;
}

std::vector<Launch> plan(const World& world, unsigned lua_processes) {
  return plan_controllers(world.scene, world.layout, world.scripts,
                          {"ipc:///e", "/f", "ziggurat-lua", lua_processes, {"--max-memory", "9"}});
}

std::vector<std::vector<std::size_t>> blocks(const std::vector<Launch>& launches) {
  std::vector<std::vector<std::size_t>> robots;
  for (const auto& launch : launches) robots.push_back(launch.robots);
  return robots;
}

using Blocks = std::vector<std::vector<std::size_t>>;

TEST(Controllers, LuaRobotsAreSharedInContiguousBlocks) {
  const auto world = world_of({0, 0, 0, 0, 0});
  EXPECT_EQ(blocks(plan(world, 1)), (Blocks{{0, 1, 2, 3, 4}}));
  EXPECT_EQ(blocks(plan(world, 2)), (Blocks{{0, 1}, {2, 3, 4}}));
  EXPECT_EQ(blocks(plan(world, 0)), (Blocks{{0}, {1}, {2}, {3}, {4}}));
  EXPECT_EQ(blocks(plan(world, 99)), (Blocks{{0}, {1}, {2}, {3}, {4}}));
}

TEST(Controllers, RobotsWithoutAProgramStartNoProcess) {
  EXPECT_TRUE(plan(world_of({}), 0).empty());
  EXPECT_TRUE(plan(world_of({2}), 1).empty()) << "a client connects";
  auto without_script = world_of({0});
  without_script.scripts[0].clear();
  EXPECT_TRUE(plan(without_script, 1).empty());
}

TEST(Controllers, CommandsFindTheServerInTheirEnvironment) {
  const auto launches = plan(world_of({1, 0, 1}), 1);
  EXPECT_EQ(blocks(launches), (Blocks{{1}, {0, 2}}));
  EXPECT_EQ(launches[0].program.arguments,
            (std::vector<std::string>{"ziggurat-lua", "--connect", "ipc:///e", "--robots-file",
                                      "/f/robots-0", "--quiet", "--max-memory", "9", "--place-file",
                                      "/f/robots-0-place"}));
  EXPECT_EQ(launches[1].program.arguments,
            (std::vector<std::string>{"/bin/sh", "-c", "./drive --fast"}));
  EXPECT_EQ(launches[1].program.environment,
            (std::vector<std::pair<std::string, std::string>>{{"ZIGGURAT_SERVER_KEY", ""},
                                                              {"ZIGGURAT_CURVE_SECRET", ""},
                                                              {"ZIGGURAT_ENDPOINT", "ipc:///e"},
                                                              {"ZIGGURAT_CONTROLLER", "drive"},
                                                              {"ZIGGURAT_SCENE_FOLDER", ""}}));
}

TEST(Controllers, LongListsOfNamesAreCut) {
  const auto world = world_of(std::vector<std::size_t>(20, 0));
  EXPECT_EQ(names_of({3}, world.layout), "robot r3");
  EXPECT_EQ(names_of({0, 1}, world.layout), "robots r0, r1");
  EXPECT_EQ(names_of({0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, world.layout),
            "robots r0, r1, r2, r3, r4, r5, r6, r7 and 2 more");
}

TEST(Controllers, OneThatCannotStartIsNamed) {
  Launch launch;
  launch.name = "the test";
  launch.program.arguments = {"/no/such/program"};
  EXPECT_EQ(words_of<std::runtime_error>([&] { start_all({launch}, {}); }),
            "the test cannot be started (/no/such/program): No such file or directory");
}

}  // namespace
}  // namespace ziggurat::processes
