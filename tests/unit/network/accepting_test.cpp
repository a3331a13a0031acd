// SPDX-License-Identifier: MIT
// When connections are accepted.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "network/curve_client.h"
#include "network/keys.h"
#include "network/local_server.h"
#include "network/raw_client.h"
#include "network/socket.h"
#include "temporary_folder.h"

namespace ziggurat::network {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

/// Sets the limit on open files while it exists.
class FileLimit {
 public:
  explicit FileLimit(rlim_t files) {
    ::getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit limit{files, before_.rlim_max};
    ::setrlimit(RLIMIT_NOFILE, &limit);
  }
  ~FileLimit() { ::setrlimit(RLIMIT_NOFILE, &before_); }

 private:
  rlimit before_{};
};

Socket with_eight_places() {
  const FileLimit limit(64);  // 48 are reserved, and half of the others is for peers with sessions
  return Socket(local_config());
}

/// As the server does, until a message has arrived or the time is over. True if one has.
bool serve(Socket& socket, milliseconds time) {
  Received received;
  for (const auto end = Clock::now() + time; Clock::now() < end;) {
    socket.tend();
    if (socket.receive(received)) return true;
    socket.poll(std::chrono::ceil<milliseconds>(end - Clock::now()), {});
  }
  return false;
}

TEST(Accepting, GoesOnByItselfAfterACrowd) {
  Socket socket = with_eight_places();
  const std::string endpoint = socket.endpoints().front();
  {
    std::vector<posix::Descriptor> crowd;
    for (int i = 0; i < 20; ++i) crowd.push_back(connect_and_send(endpoint, greeting_and(0, {})));
    EXPECT_FALSE(serve(socket, milliseconds{50}));
  }
  EXPECT_FALSE(serve(socket, milliseconds{50}));
  const posix::Descriptor late = connect_and_send(endpoint, greeting_and(1, "late"));
  EXPECT_TRUE(serve(socket, patience.timeout));
}

/// Answer of a server to a client that sends these bytes and, perhaps, closes its sending side.
std::string answer_to(Socket& socket, const std::string& said, bool ends) {
  const posix::Descriptor client = connect_and_send(socket.endpoints().front(), said);
  if (ends) ::shutdown(client.number(), SHUT_WR);
  EXPECT_FALSE(serve(socket, milliseconds{100}));
  std::string heard(1000, '\0');
  const ssize_t size = ::recv(client.number(), heard.data(), heard.size(), MSG_DONTWAIT);
  heard.resize(static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
  return heard;
}

TEST(Accepting, WhoEndsWithinTheHandshakeIsNotListenedTo) {
  using namespace std::string_literals;
  TemporaryFolder folder;
  write_key_pair(folder / "server");
  Config config = local_config();
  config.curve = {read_secret_key(folder / "server.secret"), {}};
  Socket socket(config);
  const zmtp::CurveKeys keys(*config.curve);
  const zmtp::CurveClient client(zmtp::CurveClient::make_pair(), keys.public_key());
  const std::string said =
      "\xFF\0\0\0\0\0\0\0\x01\x7F\x03\0CURVE"s + std::string(47, '\0') + client.hello();
  EXPECT_NE(answer_to(socket, said, false).find("WELCOME"), std::string::npos);
  EXPECT_EQ(answer_to(socket, said, true).find("WELCOME"), std::string::npos)
      << "or keys are multiplied for nothing";
}

}  // namespace
}  // namespace ziggurat::network
