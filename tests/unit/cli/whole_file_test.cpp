#include "cli/whole_file.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "temporary_folder.h"

namespace ziggurat::cli {
namespace {

namespace fs = std::filesystem;

class WholeFileTest : public ::testing::Test {
 protected:
  WholeFileTest() { std::ofstream(out_) << "old"; }

  /// Name and content of the only file that is in the folder.
  std::string only_file() const {
    std::string all;
    for (const auto& each : fs::directory_iterator(folder_.path)) {
      std::ifstream file(each.path());
      all += each.path().filename().string() + ": " + std::string(std::istreambuf_iterator<char>(file), {}) + "\n";
    }
    return all;
  }

  TemporaryFolder folder_;
  const std::string out_ = (folder_.path / "out.csv").string();
};

TEST_F(WholeFileTest, AppearsWhenItIsKept) {
  WholeFile file(out_);
  std::ofstream(file.path()) << "new";
  EXPECT_NE(file.path(), out_);
  file.keep();
  EXPECT_EQ(only_file(), "out.csv: new\n");
}

TEST_F(WholeFileTest, IsNotWrittenThroughALinkThatWasThereBefore) {
  const std::string part = WholeFile(out_).path();
  {
    TemporaryFolder other;
    std::ofstream(other.path / "precious") << "kept";
    fs::create_symlink(other.path / "precious", part);
    WholeFile file(out_);
    ASSERT_EQ(file.path(), part);
    std::ofstream(file.path()) << "new";
    file.keep();
    EXPECT_EQ(fs::file_size(other.path / "precious"), 4U);
  }
  EXPECT_EQ(only_file(), "out.csv: new\n");
}

TEST_F(WholeFileTest, HasAnotherPlaceIfWhatIsThereCannotBeRemoved) {
  const std::string part = WholeFile(out_).path();
  fs::create_directories(part + "/full");
  {
    WholeFile file(out_);
    EXPECT_NE(file.path(), part);
    std::ofstream(file.path()) << "new";
    file.keep();
  }
  fs::remove_all(part);
  EXPECT_EQ(only_file(), "out.csv: new\n");
}

TEST_F(WholeFileTest, IsRemovedIfItIsNotKept) {
  {
    const WholeFile file(out_);
    std::ofstream(file.path()) << "part";
  }
  EXPECT_EQ(only_file(), "out.csv: old\n");
}

TEST_F(WholeFileTest, IsRemovedByASignalThatEndsTheProgram) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    const auto end = [&] {
      ::signal(number, SIG_DFL);
      const WholeFile file(out_);
      std::ofstream(file.path()) << "part";
      ::raise(number);
    };
    EXPECT_EXIT(end(), ::testing::KilledBySignal(number), "ziggurat: interrupted; the file was not finished");
    EXPECT_EQ(only_file(), "out.csv: old\n");
  }
}

}  // namespace
}  // namespace ziggurat::cli
