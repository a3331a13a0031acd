// SPDX-License-Identifier: MIT
#include "run/options/option_checks.h"

#include <gtest/gtest.h>

#include <string>

#include "text/numbers.h"

namespace ziggurat::run {
namespace {

struct ClientOptionsTest : testing::Test {
  ClientOptionsTest() {
    scene.controllers.emplace_back().lua = true;
    config.deadlines.resize(1);
  }
  std::string refused() const {
    try {
      check_client_options(options, expected_clients(options, scene, is_serve, with_controllers),
                           config);
    } catch (const text::UsageError& error) {
      return std::string(error.what()).substr(0, std::string(error.what()).find(' '));
    }
    return "";
  }

  Options options;
  scene::Scene scene;
  network::Config config;
  bool is_serve = false, with_controllers = true;
};

TEST_F(ClientOptionsTest, WhatOnlyClientsAskForIsRefusedWithoutAny) {
  for (const bool is_of_directors : {false, true}) {
    options = {};
    options.snapshot_folder = is_of_directors ? "" : "x";
    options.allows_directors = is_of_directors;
    EXPECT_EQ(refused(), is_of_directors ? "--allow-director" : "--snapshot-folder");
    options.view = "";
    EXPECT_NE(refused(), "") << "no viewer asks for that";
    options.endpoints = {"ipc://x"};
    EXPECT_EQ(refused(), "");
    options.endpoints = {};
    is_serve = true;
    EXPECT_EQ(refused(), "");
    is_serve = false;
    options.lua_arguments = {"--trust-scripts"};
    EXPECT_EQ(refused(), "") << "they may start a program that connects";
    options.lua_arguments = {};
    scene.controllers[0].command = "./drive";
    EXPECT_EQ(refused(), "") << "it may connect as a supervisor, too";
    with_controllers = false;
    EXPECT_NE(refused(), "") << "it is not started";
    with_controllers = true;
    scene.controllers[0].command.clear();
  }
}

TEST_F(ClientOptionsTest, RobotsAreSpawnedByDirectorsAndViewersToo) {
  options.spawned_script_folders = {"x"};
  EXPECT_EQ(refused(), "--allow-spawned-scripts");
  options.view = "";
  EXPECT_EQ(refused(), "");
  options.view.reset();
  scene.directors.emplace_back().script = "judge.lua";
  EXPECT_EQ(refused(), "");
}

TEST_F(ClientOptionsTest, DropsAreAllowedWhereADeadlineDrops) {
  options.allow_drops = true;
  EXPECT_EQ(refused(), "--allow-drops");
  config.deadlines[0].policy = {scene::DeadlineAction::hold, 50, 0};
  EXPECT_EQ(refused(), "--allow-drops") << "it holds without end";
  config.deadlines[0].policy.miss_budget = 3;
  EXPECT_EQ(refused(), "");
  config.deadlines[0].policy = {scene::DeadlineAction::stop, 50, 3};
  EXPECT_EQ(refused(), "--allow-drops") << "it ends the run";
  config.deadlines[0].policy = {scene::DeadlineAction::drop, 50, 0};
  EXPECT_EQ(refused(), "");
  config.deadlines[0].policy = {};
  options.endpoints = {"ipc://x"};
  EXPECT_EQ(refused(), "") << "a client may ask for a deadline";
}

bool is_refused(const std::string& gate, const GateContext& context) {
  try {
    check_gate(reports::parse_gate(gate), context);
  } catch (const text::UsageError&) {
    return true;
  }
  return false;
}

TEST(GateOption, ConditionsThatAreAlwaysMetAreRefused) {
  std::vector<network::Config::Deadline> deadlines(2);
  EXPECT_TRUE(is_refused("p99<1s,misses<1%", {deadlines, false, true}));
  EXPECT_TRUE(is_refused("run<2", {deadlines, false, true}));
  EXPECT_FALSE(is_refused("misses<1%", {deadlines, true, true}))
      << "a client may ask for a deadline";
  EXPECT_TRUE(is_refused("late<1", {deadlines, true, false}));
  EXPECT_FALSE(is_refused("late<1", {deadlines, false, true}));
  EXPECT_FALSE(is_refused("p99<1s,max<2s,jitter<1s", {deadlines, false, false}));
  deadlines[1].policy = {scene::DeadlineAction::hold, 50, 0};
  EXPECT_FALSE(is_refused("misses<1%,run<2", {deadlines, false, false}));
}

TEST(Scopes, ThatMeanNoRobotOfTheSceneAreDoubted) {
  scene::Scene scene;
  scene.controllers.resize(1);
  scene.controllers[0].id = "wander";
  world::Layout layout;
  layout.robots.resize(2);
  layout.robots[0].id = "scout1";
  layout.robots[1].id = "r7";
  network::ClientKey fits{"k", network::all_roles, "Alice", {{"scout*", "r7"}, {"w*"}}};
  network::ClientKey misspelt{
      "key of 40 characters", network::all_roles, "", {{"zzz*", "r7", "r8"}, {"wonder"}}};
  EXPECT_EQ(doubts_of({fits, misspelt}, scene, layout),
            (std::vector<std::string>{"--curve-clients: robots=zzz*,r8 of the key key of 40 "
                                      "characters means no robot of the scene",
                                      "--curve-clients: controllers=wonder of the key key of 40 "
                                      "characters means no controller of the scene"}));
}

}  // namespace
}  // namespace ziggurat::run
