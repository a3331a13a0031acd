// SPDX-License-Identifier: MIT
#include "run/local_endpoints.h"

#include <gtest/gtest.h>

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
  LocalEndpoints local(nullptr);
  EXPECT_TRUE(local.of_server("some/vehicle.argos").starts_with("ipc://" + shared_ + "/vehicle-"));
  EXPECT_EQ(std::filesystem::status(shared_).permissions(), std::filesystem::perms::owner_all);
}

TEST_F(LocalEndpointsTest, AFolderThatOthersCanEnterIsNotUsed) {
  std::filesystem::create_directory(shared_);
  std::filesystem::permissions(shared_, std::filesystem::perms(0755));
  EXPECT_FALSE(LocalEndpoints(nullptr).of_server("vehicle.argos").starts_with("ipc://" + shared_));
}

TEST_F(LocalEndpointsTest, NorIsALinkToAnotherFolder) {
  std::filesystem::create_directory_symlink(folder_.path, shared_);
  EXPECT_FALSE(LocalEndpoints(nullptr).of_server("vehicle.argos").starts_with("ipc://" + shared_));
}

}  // namespace
}  // namespace ziggurat::run
