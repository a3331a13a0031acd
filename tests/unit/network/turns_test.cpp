// In which order connections get their messages taken.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "network/local_server.h"
#include "network/raw_client.h"
#include "network/socket.h"

namespace ziggurat::network {
namespace {

TEST(Turns, AConnectionThatSendsMuchDoesNotKeepOthersWaiting) {
  constexpr int many = 500;
  Socket socket(local_config());
  const std::string endpoint = socket.endpoints().front();
  const Descriptor busy = connect_and_send(endpoint, greeting_and(many, "busy"));
  const Descriptor other = connect_and_send(endpoint, greeting_and(1, "other"));
  const Descriptor third = connect_and_send(endpoint, greeting_and(1, "third"));
  std::vector<std::string> taken;
  Received received;
  while (taken.size() < many + 2 && socket.poll(patience.timeout, {}) != Socket::Ready::timed_out) {
    while (socket.receive(received)) taken.emplace_back(received.bytes);
  }
  ASSERT_EQ(taken.size(), static_cast<std::size_t>(many + 2));
  for (const char* name : {"other", "third"}) {
    EXPECT_LT(std::ranges::find(taken, name) - taken.begin(), 10) << name;
  }
}

}  // namespace
}  // namespace ziggurat::network
