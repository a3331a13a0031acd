// SPDX-License-Identifier: MIT
#include "sweep/experiment_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "temporary_folder.h"
#include "text/numbers.h"
#include "words_of.h"

namespace ziggurat::sweep {
namespace {

using Texts = std::vector<std::string>;

class ExperimentFileTest : public testing::Test {
 protected:
  ExperimentFile read(const std::string& text) const {
    const std::string path = folder_ / "e.toml";
    std::ofstream(path) << text;
    return read_experiment(path);
  }
  std::string refusal(const std::string& text) const {
    return words_of<text::UsageError>([&] { read(text); });
  }

  TemporaryFolder folder_;
};

TEST_F(ExperimentFileTest, SaysWhatTheCommandLineSays) {
  const ExperimentFile file = read(R"(
scene = "swarm.argos"
seeds = "1..3"
out = "results"
jobs = 2
timeout = 1.5
duration = 20
record = "failed"
run = ["--lua-processes", 2]
[parameters]
zeta = [0.5, 1, 2.0]
alpha = ["on", true]
[axes]
"physics_engines/dynamics3d/@iterations" = [5, 10]
)");
  EXPECT_EQ(file.experiment.scene, (folder_ / "swarm.argos").string());
  EXPECT_EQ(file.experiment.seeds, (std::vector<std::uint64_t>{1, 2, 3}));
  ASSERT_EQ(file.experiment.axes.size(), 3u);
  EXPECT_EQ(file.experiment.axes[0].name, "zeta") << "in the order of the file";
  EXPECT_EQ(file.experiment.axes[0].values, (Texts{"0.5", "1", "2"}));
  EXPECT_EQ(file.experiment.axes[1].values, (Texts{"on", "true"}));
  EXPECT_EQ(file.experiment.axes[2].kind, Axis::Kind::setting);
  EXPECT_EQ(file.experiment.run_arguments, (Texts{"--duration", "20", "--lua-processes", "2"}));
  EXPECT_EQ(file.out, (folder_ / "results").string());
  EXPECT_EQ(file.jobs, 2u);
  EXPECT_EQ(file.timeout, 1.5);
  EXPECT_EQ(file.record, "failed");
}

TEST_F(ExperimentFileTest, SeedsMayBeAList) {
  EXPECT_EQ(read("scene = \"s\"\nseeds = [4, \"7..8\"]").experiment.seeds,
            (std::vector<std::uint64_t>{4, 7, 8}));
}

TEST_F(ExperimentFileTest, FaultsNameTheirLine) {
  const auto has = [](const std::string& text, const char* part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  has(refusal("scene = \"s\"\nsedes = \"1..3\""),
      "e.toml:2:1: unknown key \"sedes\"; did you mean 'seeds'?");
  has(refusal("seeds = 1"), "there is no scene");
  has(refusal("scene = \"s\"\nseeds = -1"), "e.toml:2:");
  has(refusal("scene = \"s\"\njobs = 0"), "jobs must be a finite number above 0");
  has(refusal("scene = \"s\"\njobs = 1.5"), "jobs must be a whole number");
  has(refusal("scene = \"s\"\nrecord = \"some\""), "record must be");
  has(refusal("scene = \"s\"\n[parameters]\na = [[1]]"), "e.toml:3:");
  has(refusal("scene = \"s\"\n[parameters]\na = []"), "has no values");
  has(refusal("scene = \"s\"\n[parameters]\na = [1, nan]"), "e.toml:3:9: a number must be finite");
  has(refusal("scene = \"s\"\nduration = inf"), "e.toml:2:");
  has(refusal("scene = \"s\"\ntimeout = nan"), "timeout must be a finite number");
  has(refusal("scene = "), "e.toml:1:");
}

}  // namespace
}  // namespace ziggurat::sweep
