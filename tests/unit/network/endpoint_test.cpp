#include "network/endpoint.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "network/server.h"
#include "network/small_run.h"
#include "temporary_folder.h"

namespace ziggurat::network {
namespace {

std::string complaint(const std::string& endpoint, bool insecure = false) {
  try {
    check_endpoint(endpoint, insecure);
    return "";
  } catch (const EndpointError& error) {
    return error.what();
  }
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Endpoint, LoopbackIsFine) {
  for (const char* endpoint : {"tcp://127.0.0.1:7400", "tcp://127.9.8.7:*", "tcp://localhost:0",
                               "tcp://[::1]:7400", "ipc:///tmp/ziggurat-nobody"}) {
    EXPECT_EQ(complaint(endpoint), "");
  }
}

TEST(Endpoint, OtherAddressesNeedConsent) {
  for (const char* endpoint :
       {"tcp://*:7400", "tcp://0.0.0.0:7400", "tcp://192.168.1.2:7400", "tcp://eth0:7400",
        "tcp://[::]:7400", "tcp://127.0.0.1.evil.org:7400", "tcp://1270.0.0.1:1",
        "tcp://127.0.0:7400", "tcp://localhost.evil.org:7400"}) {
    EXPECT_TRUE(says(complaint(endpoint), "--insecure")) << endpoint;
    EXPECT_EQ(complaint(endpoint, true), "");
  }
}

TEST(Endpoint, Forms) {
  for (const char* endpoint : {"", "7400", "http://127.0.0.1:1", "tcp://127.0.0.1", "tcp://:1",
                               "tcp://127.0.0.1:x", "tcp://127.0.0.1:70000", "ipc://", "ipc://@"}) {
    EXPECT_TRUE(says(complaint(endpoint), "write for example")) << endpoint;
  }
}

TEST(Endpoint, LongIpcPaths) {
  EXPECT_EQ(complaint("ipc:///" + std::string(106, 'x')), "");
  const std::string text = complaint("ipc:///" + std::string(107, 'x'));
  EXPECT_TRUE(says(text, "108 bytes")) << text;
  EXPECT_TRUE(says(text, "107")) << text;
}

struct EndpointFiles : ::testing::Test {
  TemporaryFolder folder;
};

TEST_F(EndpointFiles, AFileInTheWayIsNotDeleted) {
  std::ofstream(folder / "thesis.tex") << "years of work";
  EXPECT_TRUE(says(complaint("ipc://" + (folder / "thesis.tex").string()), "in the way"));
  EXPECT_TRUE(std::filesystem::exists(folder / "thesis.tex"));
}

TEST_F(EndpointFiles, AFileWhoseNameBeginsWithAStarIsNotDeleted) {
  const std::filesystem::path former = std::filesystem::current_path();
  std::filesystem::current_path(folder / ".");
  std::ofstream("*thesis") << "years of work";
  EXPECT_TRUE(says(complaint("ipc://*thesis"), "in the way"));
  std::filesystem::current_path(former);
  EXPECT_EQ(file_of("ipc://*thesis"), "*thesis");
  EXPECT_EQ(file_of("ipc://*"), "");
}

/// It has no permissions: all processes of this machine reach it, as they reach 127.0.0.1.
TEST(Endpoint, AnAbstractPathIsNoFile) {
  EXPECT_EQ(complaint("ipc://@arena"), "");
  EXPECT_EQ(file_of("ipc://@arena"), "");
}

TEST_F(EndpointFiles, AnotherServersSocketIsNotTaken) {
  const SmallRun small(0);
  Config config;
  config.endpoints = {"ipc://" + (folder / "arena").string()};
  {
    const Server first(config, small.run());
    EXPECT_TRUE(says(complaint(config.endpoints[0]), "another server"));
    EXPECT_TRUE(std::filesystem::exists(folder / "arena"));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "arena"));
  EXPECT_EQ(complaint(config.endpoints[0]), "");
}

TEST_F(EndpointFiles, AFolderThatDoesNotExist) {
  const SmallRun small(0);
  Config config;
  config.endpoints = {"ipc://" + (folder / "no" / "arena").string()};
  EXPECT_THROW(Server(config, small.run()), EndpointError);
}

}  // namespace
}  // namespace ziggurat::network
