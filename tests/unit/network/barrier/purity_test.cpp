// SPDX-License-Identifier: MIT
// The barrier knows no sockets and reads no clock, so that tests and fuzzers can play any sequence
// of events at any time.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "checkout/checkout.h"

namespace ziggurat::network {
namespace {

TEST(Purity, NoSocketNoClockNoFacade) {
  const std::regex impure(
      R"(zmq|_clock::now|Clock::now|\bsleep|"network/(server|socket|gatekeeper|endpoint)\.h")");
  std::size_t files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(checkout() / "server/network/barrier")) {
    std::ostringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    EXPECT_FALSE(std::regex_search(text.str(), impure)) << entry.path();
    ++files;
  }
  EXPECT_GT(files, 20U);
}

}  // namespace
}  // namespace ziggurat::network
