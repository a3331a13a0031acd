// When connections are accepted.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <vector>

#include "network/curve_client.h"
#include "network/keys.h"
#include "network/local_server.h"
#include "network/raw_client.h"
#include "network/socket.h"
#include "network/time_share.h"
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
    std::vector<Descriptor> crowd;
    for (int i = 0; i < 20; ++i) crowd.push_back(connect_and_send(endpoint, greeting_and(0, {})));
    EXPECT_FALSE(serve(socket, milliseconds{50}));
  }
  EXPECT_FALSE(serve(socket, milliseconds{50}));
  const Descriptor late = connect_and_send(endpoint, greeting_and(1, "late"));
  EXPECT_TRUE(serve(socket, patience.timeout));
}

/// What clients cost that connect, say something and are gone before it is read.
ThreadClock::duration cost_of_gone(Socket& socket, const std::string& said) {
  constexpr int clients = 100;
  for (int i = 0; i < clients; ++i) connect_and_send(socket.endpoints().front(), said);
  const auto begin = ThreadClock::now();
  EXPECT_FALSE(serve(socket, milliseconds{200}));
  return ThreadClock::now() - begin;
}

TEST(Accepting, WhoEndsWithinTheHandshakeIsNotListenedTo) {
  using namespace std::string_literals;
  TemporaryFolder folder;
  write_key_pair(folder / "server");
  Config config = local_config();
  config.curve = {read_secret_key(folder / "server.secret"), {}};
  Socket socket(config);
  const std::string greeting = "\xFF\0\0\0\0\0\0\0\x01\x7F\x03\0CURVE"s + std::string(47, '\0');
  const zmtp::CurveKeys keys(*config.curve);
  const zmtp::CurveClient client(zmtp::CurveClient::make_pair(), keys.public_key());
  cost_of_gone(socket, greeting);
  const auto of_greetings = cost_of_gone(socket, greeting), of_hellos = cost_of_gone(socket, greeting + client.hello());
  EXPECT_LT(of_hellos.count(), 1.6 * static_cast<double>(of_greetings.count())) << "or keys are multiplied for nothing";
}

}  // namespace
}  // namespace ziggurat::network
