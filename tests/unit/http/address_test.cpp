// SPDX-License-Identifier: MIT
#include "http/address.h"

#include <gtest/gtest.h>

#include "text/numbers.h"

namespace ziggurat::http {
namespace {

TEST(Address, OfAnOption) {
  EXPECT_EQ(to_address("--view", "[::1]:0").host, "::1");
  EXPECT_EQ(to_address("--view", "localhost:99").port, 99);
  EXPECT_EQ(to_address("--view", "*:0").host, "0.0.0.0");
  for (const char* wrong : {"8765", ":8765", "host:", "host:x", "host:65536"}) {
    EXPECT_THROW(to_address("--view", wrong), text::UsageError) << wrong;
  }
}

TEST(Address, OnlyThisMachineReachesLoopback) {
  EXPECT_TRUE(is_loopback("127.8.0.1"));
  EXPECT_TRUE(is_loopback("[::1]"));
  EXPECT_FALSE(is_loopback("127.evil.example"));
  EXPECT_FALSE(is_loopback("0.0.0.0"));
}

TEST(Host, IsANumberLocalhostOrTheOwnName) {
  for (const char* called :
       {"", "localhost:1", "LocalHost", "127.0.0.1", "[::1]:8765", "robots.lab:80"}) {
    EXPECT_TRUE(allows_host("Robots.lab", called)) << called;
  }
  for (const char* called :
       {"evil.example:8765", "127.0.0.1.evil.example", "robots.lab.evil.example",
        "localhost:80.evil.example", "[::1]:80@evil.example"}) {
    EXPECT_FALSE(allows_host("Robots.lab", called)) << called;
  }
}

}  // namespace
}  // namespace ziggurat::http
