#include "run/local_endpoints.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "temporary_folder.h"

namespace ziggurat::run {
namespace {

class LocalEndpointsTest : public ::testing::Test {
 protected:
  LocalEndpointsTest() { ::setenv("XDG_RUNTIME_DIR", folder_.path.c_str(), 1); }
  ~LocalEndpointsTest() override { ::unsetenv("XDG_RUNTIME_DIR"); }

  const TemporaryFolder folder_;
  const std::string shared_ = folder_ / "ziggurat";
};

TEST_F(LocalEndpointsTest, OfServersAreInAFolderOfThisUser) {
  {
    LocalEndpoints local(nullptr);
    EXPECT_TRUE(
        local.of_server("some/vehicle.argos").starts_with("ipc://" + shared_ + "/vehicle-"));
    EXPECT_EQ(std::filesystem::status(shared_).permissions(), std::filesystem::perms::owner_all);
  }
  EXPECT_FALSE(std::filesystem::exists(shared_)) << "nobody uses it any more";
}

TEST_F(LocalEndpointsTest, AFolderThatOthersCanEnterIsNotWaitedFor) {
  ASSERT_EQ(::mkdir(shared_.c_str(), 0700), 0);
  ASSERT_EQ(::chmod(shared_.c_str(), 0755), 0);
  const posix::Descriptor other(::open(shared_.c_str(), O_RDONLY | O_DIRECTORY));
  ASSERT_EQ(::flock(other.number(), LOCK_EX), 0);
  LocalEndpoints local(nullptr);
  EXPECT_FALSE(local.of_server("vehicle.argos").starts_with("ipc://" + shared_));
}

}  // namespace
}  // namespace ziggurat::run
