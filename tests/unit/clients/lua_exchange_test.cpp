// SPDX-License-Identifier: MIT
// A script before the limit of its session, against a server that the test scripts.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "equipped_robots.h"
#include "fake_server.h"
#include "program/runner.h"

namespace ziggurat::lua {
namespace {

TEST(Exchange, ARobotThatSendsTooMuchForTheSessionFails) {
  FakeServer server([](FakeServer& self) {
    self.welcome(welcome());  // a session may send 4 MiB at a tick
    self.send(observation(0));
    const auto leave = self.receive().leave();
    ASSERT_EQ(leave.robots_size(), 1);
    EXPECT_EQ(leave.robots(0), 2U);
    EXPECT_EQ(leave.reason(), v1::Leave::FAILED);
    EXPECT_NE(leave.message().find("bytes by radio at this tick"), std::string::npos);
    EXPECT_GE(self.receive().command().radio_messages_size(), 3);
    self.finish();
  });
  const std::filesystem::path path = std::filesystem::path(::testing::TempDir()) / "exchange.lua";
  ProgramOptions options;
  options.script = path;
  options.quiet = true;
  std::ofstream(path) << R"lua(
    function init()
      if robot.id ~= "c" then return end
      local long = {}
      for i = 1, 1 << 20 do long[i] = 0 end
      for i = 1, 5 do robot.radios.mouth.tx_data(long) end
    end
    function step() end
  )lua";
  ziggurat::Session session(options_for(server));
  Runner runner(session, options);
  runner.run();
  EXPECT_TRUE(runner.has_failures());
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace ziggurat::lua
