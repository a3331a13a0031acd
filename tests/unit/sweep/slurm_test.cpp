#include "sweep/slurm.h"

#include <gtest/gtest.h>

namespace ziggurat::sweep {
namespace {

TEST(SlurmScript, WritesPathsAsSbatchAndTheShellReadThem) {
  const Folder folder("/data/50%a \"x\"");
  const std::string script =
      slurm_script(folder, {0, 1, 2, 5}, {"/usr/bin/ziggurat", "sweep", "task", folder.path().string()},
                   3, {"short", {"--mem=2G"}});
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

}  // namespace
}  // namespace ziggurat::sweep
