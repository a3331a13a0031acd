// SPDX-License-Identifier: MIT
#include "cli/options.h"

#include <gtest/gtest.h>

#include <array>

#include "text/numbers.h"
#include "words_of.h"

namespace ziggurat::cli {
namespace {

/// Any file that is there: options are read without its content.
const std::string scene = "/dev/null";

run::Options run(const Arguments& arguments) { return parse_options(arguments, run::by_run); }

TEST(Options, DefaultsAreThoseOfTheHelp) {
  const auto options = run({"scene.argos"});
  EXPECT_EQ(run::only_scene(options), "scene.argos");
  EXPECT_EQ(options.lua_processes, std::nullopt);
  EXPECT_EQ(options.threads, 0u) << "chosen by the world";
  EXPECT_EQ(options.scene_file.max_size, std::size_t{64} << 20);
  EXPECT_FALSE(options.ticks || options.duration || options.seed || options.scene_file.clock ||
               options.real_time || options.hash || options.quiet || options.insecure);
}

TEST(Options, AreTakenFromTheCommandLine) {
  const auto options = run({scene,
                            "--ticks",
                            "7",
                            "--seed=0",
                            "--clock",
                            "beta50",
                            "--real-time",
                            "2",
                            "--threads",
                            "3",
                            "--lua-processes",
                            "0",
                            "--controller",
                            "a=x --y=z",
                            "--endpoint",
                            "tcp://127.0.0.1:1",
                            "--endpoint",
                            "ipc:///tmp/x",
                            "--hash",
                            "--trace",
                            "t.csv",
                            "--lenient",
                            "--set",
                            "arena/@size=2,2,1",
                            "--param=gain=0.5"});
  ASSERT_EQ(options.scene_file.variation.settings.size(), 1u);
  EXPECT_EQ(options.scene_file.variation.settings[0].value, "2,2,1");
  ASSERT_EQ(options.scene_file.variation.parameters.size(), 1u);
  EXPECT_EQ(options.scene_file.variation.parameters[0].first, "gain");
  EXPECT_EQ(options.ticks, 7u);
  EXPECT_EQ(options.seed, 0u);
  EXPECT_EQ(options.scene_file.clock, scene::Clock::beta50);
  EXPECT_EQ(options.real_time, 2.0);
  EXPECT_EQ(options.lua_processes, 0u);
  EXPECT_EQ(options.threads, 3u);
  ASSERT_EQ(options.controllers.size(), 1u);
  EXPECT_EQ(options.controllers[0], (std::pair<std::string, std::string>("a", "x --y=z")));
  EXPECT_EQ(options.endpoints, (std::vector<std::string>{"tcp://127.0.0.1:1", "ipc:///tmp/x"}));
  EXPECT_TRUE(options.hash && options.scene_file.lenient);
  EXPECT_EQ(options.trace, "t.csv");
}

TEST(Options, WrongValuesAreRefused) {
  for (const Arguments& arguments :
       {Arguments{"--ticks", "-1"}, Arguments{"--duration", "-1"}, Arguments{"--duration", "nan"},
        Arguments{"--duration", "1e10"}, Arguments{"--ticks", "9007199254740993"},
        Arguments{"--threads", "0"}, Arguments{"--real-time=0"}, Arguments{"--clock", "fast"},
        Arguments{"--controller", "x"}, Arguments{"--controller", "=x"},
        Arguments{"--set", "arena"}, Arguments{"--param", "=1"},
        Arguments{"--ticks", "1", "--duration", "1"}}) {
    EXPECT_THROW(run(arguments), text::UsageError) << arguments.front();
  }
}

TEST(Options, ServeStartsNoProcesses) {
  EXPECT_THROW(parse_options({scene, "--lua-processes", "2"}, run::by_serve), text::UsageError);
}

TEST(Options, ExactlyOneSceneIsAllowed) {
  EXPECT_THROW(run::only_scene(run({})), text::UsageError);
  EXPECT_THROW(run::only_scene(run({"a", "b"})), text::UsageError);
}

TEST(Options, InsecureNeedsAnAddressThatOthersCanReach) {
  for (const Arguments& arguments :
       {Arguments{scene, "--insecure"},
        Arguments{scene, "--insecure", "--endpoint", "ipc:///tmp/x"}}) {
    EXPECT_THROW(run(arguments), text::UsageError);
  }
  for (const Arguments& more : {Arguments{"--endpoint", "tcp://127.0.0.1:1"}, Arguments{"--view"},
                                Arguments{"--metrics", "127.0.0.1:0"}}) {
    Arguments arguments{scene, "--insecure"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_TRUE(run(arguments).insecure) << more.front();
  }
}

TEST(Options, WhatIsGivenTwiceForTheSameIsRefused) {
  for (const auto& [option, first, second] :
       {std::array{"--deadline", "hold:50", "wait"},
        std::array{"--deadline", "a=hold:50", "a=wait"},
        std::array{"--set", "arena/@size=1,1,1", "arena/@size=2,2,2"},
        std::array{"--param", "gain=1", "gain=2"}, std::array{"--controller", "a=x", "a=y"},
        std::array{"--restart", "1", "2"},
        std::array{"--inject", "latency=1ms", "commands:loss=1%"}}) {
    EXPECT_TRUE(fails_with<text::UsageError>(std::string(option) + " is given twice for ", [&] {
      run({scene, option, first, option, second});
    }));
  }
  EXPECT_EQ(run({scene, "--deadline", "hold:50", "--deadline", "a=wait", "--inject",
                 "a=commands:loss=1%", "--inject", "a=observations:loss=2%", "--restart", "1",
                 "--restart", "a=2", "--param", "a=1", "--param", "b=1"})
                .deadlines.size(),
            2u);
}

TEST(Options, KeysNeedEachOther) {
  EXPECT_THROW(parse_options({scene, "--curve-secret", "x"}, run::by_serve), text::UsageError);
  EXPECT_THROW(parse_options({scene, "--curve-clients", "x"}, run::by_run), text::UsageError);
  EXPECT_EQ(parse_options({scene, "--lease", "2.5"}, run::by_serve).lease, 2.5);
  EXPECT_THROW(parse_options({scene, "--lease", "-1"}, run::by_run), text::UsageError);
}

}  // namespace
}  // namespace ziggurat::cli
