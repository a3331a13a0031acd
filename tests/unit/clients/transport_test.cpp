// The way over ZeroMQ's sockets. The one without them: local_stream_test.cpp.

#include "transport.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <thread>
#include <zmq.hpp>

#include "ziggurat/error.h"

namespace ziggurat {
namespace {

TEST(Transport, AConnectionThatIsRefusedTellsTheSender) {
  std::array<char, 41> open{}, secret{};
  ASSERT_EQ(zmq_curve_keypair(open.data(), secret.data()), 0);
  zmq::context_t context;
  zmq::socket_t server(context, zmq::socket_type::router);
  server.set(zmq::sockopt::linger, 0);
  server.set(zmq::sockopt::curve_server, 1);
  server.set(zmq::sockopt::curve_secretkey, secret.data());
  server.bind("tcp://127.0.0.1:*");

  SessionOptions without_keys;
  without_keys.endpoint = server.get(zmq::sockopt::last_endpoint);
  const auto transport = make_transport(without_keys);
  // What is sent before the refusal is known goes into a queue that ZeroMQ then drops.
  const auto send_for_long = [&] {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (std::chrono::steady_clock::now() < end) {
      transport->send(1, [](char* to) { *to = 0; });
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  };
  EXPECT_THROW(send_for_long(), ConnectionError) << "without a queue ZeroMQ alone would wait without end";
}

}  // namespace
}  // namespace ziggurat
