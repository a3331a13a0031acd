// SPDX-License-Identifier: MIT
#include "text/hosts.h"

#include <gtest/gtest.h>

namespace ziggurat::text {
namespace {

TEST(HostToCall, IsLoopbackWhereAServerListensAtAllAddresses) {
  EXPECT_EQ(host_to_call("0.0.0.0"), "127.0.0.1");
  EXPECT_EQ(host_to_call("*"), "127.0.0.1");
  EXPECT_EQ(host_to_call("::"), "::1");
  EXPECT_EQ(host_to_call("robots.lab"), "robots.lab");
  EXPECT_EQ(host_to_call("192.0.2.1"), "192.0.2.1");
}

TEST(EndpointToCall, KeepsThePort) {
  EXPECT_EQ(endpoint_to_call("tcp://0.0.0.0:5770"), "tcp://127.0.0.1:5770");
  EXPECT_EQ(endpoint_to_call("tcp://[::]:5770"), "tcp://[::1]:5770");
  for (const char* other :
       {"tcp://192.0.2.1:5770", "tcp://[::1]:5770", "ipc:///run/0.0.0.0:1", "tcp:"})
    EXPECT_EQ(endpoint_to_call(other), other);
}

TEST(NoteOfEveryHost, IsForThemAlone) {
  EXPECT_NE(note_of_every_host("0.0.0.0").find("in place of 127.0.0.1"), std::string::npos);
  EXPECT_EQ(note_of_every_host("127.0.0.1"), "");
  EXPECT_EQ(note_of_every_host(host_of_endpoint("ipc:///run/x")), "");
}

}  // namespace
}  // namespace ziggurat::text
