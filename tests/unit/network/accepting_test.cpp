// When connections are accepted.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <vector>

#include "network/local_server.h"
#include "network/raw_client.h"
#include "network/socket.h"

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
    std::vector<Descriptor> crowd;
    for (int i = 0; i < 20; ++i) crowd.push_back(connect_and_send(endpoint, greeting_and(0, {})));
    EXPECT_FALSE(serve(socket, milliseconds{50}));
  }
  EXPECT_FALSE(serve(socket, milliseconds{50}));
  const Descriptor late = connect_and_send(endpoint, greeting_and(1, "late"));
  EXPECT_TRUE(serve(socket, patience.timeout));
}

}  // namespace
}  // namespace ziggurat::network
