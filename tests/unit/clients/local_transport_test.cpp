// A connection to a server of this machine, byte by byte.

#include "local_transport.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <string>
#include <thread>

#include "temporary_folder.h"
#include "waiting.h"
#include "ziggurat/error.h"
#include "zmtp/frame.h"

namespace ziggurat {
namespace {

using std::chrono::milliseconds;

struct LocalTransportTest : ::testing::Test {
  ~LocalTransportTest() override {
    ::close(server);
    ::close(listener);
  }
  void listen() {
    listener = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    ASSERT_EQ(::bind(listener, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    ASSERT_EQ(::listen(listener, 4), 0);
  }
  void accept(const std::string& said) {
    server = ::accept(listener, nullptr, nullptr);
    const std::string greeting = zmtp::greeting("NULL", false);
    std::string heard;
    while (heard.size() < greeting.size() + ready("DEALER").size()) heard += hear(1);
    EXPECT_EQ(heard, greeting + ready("DEALER"));
    say(said);
  }
  static std::string ready(const char* type) {
    std::string bytes;
    zmtp::append_command(bytes, "READY", zmtp::metadata_of(type));
    return bytes;
  }
  static std::string handshake(const char* mechanism = "NULL") {
    return zmtp::greeting(mechanism, true) + ready("ROUTER");
  }
  static std::string frame(const std::string& body) {
    std::string bytes(zmtp::header_length(body.size()), '\0');
    zmtp::write_header(body.size(), reinterpret_cast<std::uint8_t*>(bytes.data()));
    return bytes + body;
  }
  std::string hear(std::size_t most = 1 << 16) {
    std::string bytes(most, '\0');
    bytes.resize(static_cast<std::size_t>(
        std::max<ssize_t>(0, ::recv(server, bytes.data(), bytes.size(), 0))));
    return bytes;
  }
  void say(const std::string& bytes) {
    ASSERT_EQ(::send(server, bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
  }
  void open() {
    listen();
    make();
    accept(handshake());
    EXPECT_FALSE(transport->receive(milliseconds{20}));
  }
  void make() { transport = make_local_transport("ipc://" + path, "no keys"); }
  void send(const std::string& message) {
    transport->send(message.size(), [&](char* to) { message.copy(to, message.size()); });
  }
  std::string refusal() {
    try {
      transport->was_closed();
    } catch (const ConnectionError& error) {
      return error.what();
    }
    return "none";
  }

  TemporaryFolder folder;
  const std::string path = (folder / "socket").string();
  int listener = -1, server = -1;
  std::unique_ptr<Transport> transport;
};

TEST_F(LocalTransportTest, MessagesAreCutFromAnyPieces) {
  open();
  const std::string bodies[] = {"", "x", std::string(255, 'y'), std::string(256, 'z'),
                                std::string(100'000, 'w')};
  std::string stream;
  for (const std::string& body : bodies) stream += frame(body);
  for (const std::size_t size :
       {std::size_t{1}, std::size_t{7}, std::size_t{1000}, stream.size()}) {
    std::thread writer([&] {
      for (std::size_t i = 0; i < stream.size(); i += size) say(stream.substr(i, size));
    });
    for (const std::string& body : bodies) {
      EXPECT_TRUE(comes_true([&] { return transport->receive(milliseconds{500}); }));
      EXPECT_EQ(transport->content(), body);
      EXPECT_FALSE(transport->has_more());
    }
    writer.join();
  }
  say("\1\1a");
  ASSERT_TRUE(transport->receive(milliseconds{500}));
  EXPECT_TRUE(transport->has_more());
}

TEST_F(LocalTransportTest, WhatIsSentBeforeThereIsAServerArrivesFirst) {
  make();
  send("first");
  EXPECT_FALSE(transport->receive(milliseconds{5}));
  EXPECT_FALSE(transport->is_accepted());
  listen();
  EXPECT_FALSE(transport->receive(milliseconds{50}));
  EXPECT_TRUE(transport->is_accepted());
  accept(handshake());
  EXPECT_FALSE(transport->receive(milliseconds{20}));
  send("second");
  EXPECT_EQ(hear(), frame("first") + frame("second"));
}

TEST_F(LocalTransportTest, AConnectionThatEndsWithinItsHandshakeIsTriedAgain) {
  listen();
  make();
  send("hello");
  accept(handshake().substr(0, zmtp::first_of_greeting));
  ::close(server);
  EXPECT_FALSE(transport->receive(milliseconds{100}));
  EXPECT_FALSE(transport->was_closed());
  accept(handshake());
  EXPECT_FALSE(transport->receive(milliseconds{20}));
  EXPECT_EQ(hear(), frame("hello"));
}

TEST_F(LocalTransportTest, WhatTheServerHasSentIsReadBeforeItsEnd) {
  open();
  say(frame("last"));
  ::close(std::exchange(server, -1));
  ASSERT_TRUE(transport->receive(milliseconds{500}));
  EXPECT_EQ(transport->content(), "last");
  EXPECT_FALSE(transport->receive(milliseconds{500}));
  EXPECT_TRUE(transport->was_closed());
  EXPECT_THROW(send("more"), ConnectionError);
}

TEST_F(LocalTransportTest, WhatWaitsForAServerThatReadsNothingIsSentLater) {
  open();
  const std::string large(2'000'000, 'l');
  send(large);
  std::string heard;
  std::thread reader([&] {
    while (heard.size() < frame(large).size()) heard += hear();
  });
  comes_true([&] { return !transport->receive(milliseconds{0}) && heard.size() > large.size(); });
  transport->linger();
  transport.reset();
  reader.join();
  EXPECT_EQ(heard, frame(large));
}

TEST_F(LocalTransportTest, AServerThatIsLeftIsToldWhy) {
  using namespace std::string_literals;
  listen();
  for (const auto& [said, why] :
       {std::pair{handshake("CURVE"), "no keys"}, std::pair{std::string(64, 'h'), "ZMTP 3"},
        std::pair{handshake() + "\x80\0"s, "none of ZMTP 3"},
        std::pair{handshake() + "\2\0\0\1\0\0\0\0\0"s, "too long"}}) {
    make();
    accept(said);
    EXPECT_FALSE(transport->receive(milliseconds{500}));
    EXPECT_NE(refusal().find(why), std::string::npos) << refusal();
    EXPECT_THROW(send("more"), ConnectionError);
    ::close(std::exchange(server, -1));
  }
}

TEST_F(LocalTransportTest, APathThatCanNotBeIsTold) {
  for (const std::string& wrong :
       {std::string(), std::string("@"), std::string("*"), std::string(108, 'x')}) {
    EXPECT_THROW(make_local_transport("ipc://" + wrong, "no keys"), std::invalid_argument);
  }
}

}  // namespace
}  // namespace ziggurat
