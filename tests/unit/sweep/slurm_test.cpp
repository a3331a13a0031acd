// SPDX-License-Identifier: MIT
#include "sweep/slurm.h"

#include <gtest/gtest.h>

#include "text/numbers.h"

namespace ziggurat::sweep {
namespace {

TEST(SlurmScript, WritesPathsAsSbatchAndTheShellReadThem) {
  const Folder folder("/data/50%a \"x\"");
  const std::string script = slurm_script(
      folder, {0, 1, 2, 5}, {"/usr/bin/ziggurat", "sweep", "task", folder.path().string()}, 3,
      {"short", {"--mem=2G"}});
  const auto has = [&](const std::string& part) {
    EXPECT_NE(script.find(part + "\n"), std::string::npos) << part << "\n" << script;
  };
  has("#SBATCH --array=0-2,5");
  has("#SBATCH --cpus-per-task=3");
  has("#SBATCH --partition=short");
  has("#SBATCH --mem=2G");
  has(R"(#SBATCH --output="/data/50%%a \"x\"/cluster/task-%a.log")");
  has(R"(exec /usr/bin/ziggurat sweep task '/data/50%a "x"')");
}

TEST(SlurmScript, ALineBreakDoesNotEndAnOption) {
  for (const char* each : {"\n", "\r", "\ntouch x\n"}) {
    const auto script = [&](const std::string& folder, const SlurmOptions& options) {
      return slurm_script(Folder(folder), {0}, {"ziggurat"}, 1, options);
    };
    EXPECT_THROW(script(std::string("/data/a") + each + "b", {}), text::UsageError);
    EXPECT_THROW(script("/data", {std::string("short") + each, {}}), text::UsageError);
    EXPECT_THROW(script("/data", {"", {std::string("--mem=2G") + each}}), text::UsageError);
  }
}

}  // namespace
}  // namespace ziggurat::sweep
