// SPDX-License-Identifier: MIT
#include "network/endpoint.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <barrier>
#include <filesystem>
#include <fstream>
#include <thread>
#include <vector>

#include "network/listener.h"
#include "network/server.h"
#include "network/small_run.h"
#include "temporary_folder.h"
#include "words_of.h"

namespace ziggurat::network {
namespace {

std::string complaint(const std::string& endpoint, bool insecure = false) {
  return words_of<EndpointError>([&] { check_endpoint(endpoint, insecure); });
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
  for (const char* endpoint :
       {"", "7400", "http://127.0.0.1:1", "tcp://127.0.0.1", "tcp://:1", "ipc://", "ipc://@"}) {
    EXPECT_TRUE(says(complaint(endpoint), "write for example")) << endpoint;
  }
}

TEST(Endpoint, PortsAreNumbersUpTo65535) {
  for (const char* port :
       {"99999", "65536", "-1", "", "x", "1x", " 1", "+1", "99999999999999999999"}) {
    EXPECT_TRUE(
        says(complaint(std::string("tcp://127.0.0.1:") + port),
             "the port is '" + std::string(port) + "'; it must be a number from 1 to 65535"))
        << port;
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

TEST_F(EndpointFiles, AFileThatIsMadeLaterIsNotDeletedEither) {
  const std::string path = (folder / "thesis.tex").string();
  std::ofstream(path) << "years of work";  // after check_endpoint()
  EXPECT_THROW(Listener("ipc://" + path), EndpointError);
  EXPECT_TRUE(std::filesystem::is_regular_file(path));
}

/// One listens, and the others say so: none removes the socket of another.
TEST_F(EndpointFiles, OfServersThatBeginAtOnePathAtOnceOneListens) {
  const std::string path = (folder / "arena").string();
  for (int round = 0; round < 50; ++round) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, path.size());
    const int dead = ::socket(AF_UNIX, SOCK_STREAM, 0);
    ASSERT_EQ(::bind(dead, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    ::close(dead);
    std::atomic<int> listening = 0;
    std::barrier begin(4), done(4);
    std::vector<std::thread> servers;
    for (int i = 0; i < 4; ++i) {
      servers.emplace_back([&] {
        begin.arrive_and_wait();
        try {
          const Listener listener("ipc://" + path);
          ++listening;
          done.arrive_and_wait();
        } catch (const EndpointError&) {
          done.arrive_and_wait();
        }
      });
    }
    for (std::thread& server : servers) server.join();
    ASSERT_EQ(listening, 1) << "in round " << round;
  }
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
