// SPDX-License-Identifier: MIT
#include "cli/atomic_file.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "temporary_folder.h"

namespace ziggurat::cli {
namespace {

namespace fs = std::filesystem;

class AtomicFileTest : public ::testing::Test {
 protected:
  AtomicFileTest() { std::ofstream(out_) << "old"; }

  /// Name and content of the only file that is in the folder.
  std::string only_file() const {
    std::string all;
    for (const auto& each : fs::directory_iterator(folder_.path)) {
      std::ifstream file(each.path());
      all += each.path().filename().string() + ": " +
             std::string(std::istreambuf_iterator<char>(file), {}) + "\n";
    }
    return all;
  }

  TemporaryFolder folder_;
  const std::string out_ = (folder_.path / "out.csv").string();
};

TEST_F(AtomicFileTest, AppearsWhenItIsKept) {
  AtomicFile file(out_);
  std::ofstream(file.path()) << "new";
  EXPECT_NE(file.path(), out_);
  file.commit();
  EXPECT_EQ(only_file(), "out.csv: new\n");
}

TEST_F(AtomicFileTest, IsNotWrittenThroughALinkThatWasThereBefore) {
  const std::string part = AtomicFile(out_).path();
  {
    TemporaryFolder other;
    std::ofstream(other.path / "precious") << "kept";
    fs::create_symlink(other.path / "precious", part);
    AtomicFile file(out_);
    ASSERT_EQ(file.path(), part);
    std::ofstream(file.path()) << "new";
    file.commit();
    EXPECT_EQ(fs::file_size(other.path / "precious"), 4U);
  }
  EXPECT_EQ(only_file(), "out.csv: new\n");
}

TEST_F(AtomicFileTest, IsRemovedIfItIsNotKept) {
  {
    const AtomicFile file(out_);
    std::ofstream(file.path()) << "part";
  }
  EXPECT_EQ(only_file(), "out.csv: old\n");
}

TEST_F(AtomicFileTest, IsRemovedByASignalThatEndsTheProgram) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    const auto end = [&] {
      ::signal(number, SIG_DFL);
      const AtomicFile file(out_);
      std::ofstream(file.path()) << "part";
      ::raise(number);
    };
    EXPECT_EXIT(end(), ::testing::KilledBySignal(number),
                "ziggurat: interrupted; the file was not finished");
    EXPECT_EQ(only_file(), "out.csv: old\n");
  }
}

}  // namespace
}  // namespace ziggurat::cli
