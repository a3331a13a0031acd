// The client's end of ZeroMQ's wire protocol, against a socket on which the test writes the bytes.

#include "plain_stream.h"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <string>
#include <thread>
#include <utility>

#include "waiting.h"
#include "ziggurat/error.h"

namespace ziggurat {
namespace {

using namespace std::chrono_literals;

/// Over a path, or a port of this machine.
class PlainStreams : public testing::TestWithParam<bool> {
 protected:
  PlainStreams() {
    if (GetParam()) {
      bind();  // and listen later
      options_.endpoint = "tcp://127.0.0.1:" + std::to_string(ntohs(port_));
    } else {
      options_.endpoint = "ipc://" + path_;
      std::filesystem::remove(path_);
    }
  }
  ~PlainStreams() override {
    for (const int open : {client_, listener_}) {
      if (open >= 0) ::close(open);
    }
    std::filesystem::remove(path_);
  }
  PlainEndpoint endpoint() { return PlainEndpoint::of(options_).value(); }

  void bind() {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = port_;
    socklen_t size = sizeof address;
    const int on = 1;
    listener_ = ::socket(AF_INET, SOCK_STREAM, 0);
    ::setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    ASSERT_EQ(::bind(listener_, reinterpret_cast<sockaddr*>(&address), size), 0);
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = address.sin_port;
  }
  void bind_path() {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strcpy(address.sun_path, path_.c_str());
    listener_ = ::socket(AF_UNIX, SOCK_STREAM, 0);
    ASSERT_EQ(::bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  }
  void listen() {
    if (listener_ < 0) GetParam() ? bind() : bind_path();
    ASSERT_EQ(::listen(listener_, 4), 0);
  }
  void accept() {
    pollfd waiting{listener_, POLLIN, 0};
    ASSERT_EQ(::poll(&waiting, 1, 5000), 1) << "no connection within 5 s";
    client_ = ::accept(listener_, nullptr, nullptr);
    ASSERT_GE(client_, 0);
  }
  void write(const std::string& bytes) {
    ASSERT_EQ(::send(client_, bytes.data(), bytes.size(), MSG_NOSIGNAL), ssize_t(bytes.size()));
  }
  /// Waits for so many bytes.
  std::string read(std::size_t size) {
    std::string bytes(size, '\0');
    for (std::size_t have = 0; have < size;) {
      pollfd waiting{client_, POLLIN, 0};
      if (::poll(&waiting, 1, 5000) != 1) return "nothing within 5 s";
      const ssize_t count = ::recv(client_, bytes.data() + have, size - have, 0);
      if (count <= 0) return "closed";
      have += static_cast<std::size_t>(count);
    }
    return bytes;
  }
  static std::string greeting() {
    std::string bytes(64, '\0');
    bytes[0] = '\xff', bytes[8] = 1, bytes[9] = '\x7f', bytes[10] = 3, bytes[11] = 1;
    return bytes.replace(12, 4, "NULL");
  }
  static std::string ready() {
    const std::string body = std::string("\5READY\13Socket-Type\0\0\0\6ROUTER", 28);
    return std::string("\4") + static_cast<char>(body.size()) + body;
  }
  static std::string frame(const std::string& content) {
    if (content.size() < 256)
      return std::string(1, '\0') + static_cast<char>(content.size()) + content;
    std::string header(9, '\0');
    header[0] = 2;
    for (int i = 0; i < 8; ++i) header[8 - i] = static_cast<char>(content.size() >> 8 * i & 0xff);
    return header + content;
  }
  void shake_hands(PlainStream& stream) {
    accept();
    write(greeting() + ready());
    EXPECT_FALSE(stream.receive(10ms));
    EXPECT_EQ(read(64), greeting());
    const std::string header = read(2);
    ASSERT_EQ(header[0], 4);
    EXPECT_EQ(read(static_cast<unsigned char>(header[1])).substr(0, 6), "\5READY");
  }
  static void send(PlainStream& stream, const std::string& text) {
    stream.send(text.size(), [&](char* to) { std::memcpy(to, text.data(), text.size()); });
  }

  in_port_t port_ = 0;  // in the network's order
  std::string path_ = testing::TempDir() + "plain_stream_" + std::to_string(::getpid());
  Options options_;
  int listener_ = -1, client_ = -1;
};

TEST_P(PlainStreams, AServerThatNeverStopsWithCommandsIsNotListenedToWithoutEnd) {
  listen();
  std::thread server;
  {
    PlainStream stream(endpoint());
    shake_hands(stream);
    server = std::thread([this] {
      std::string pings;
      while (pings.size() < 1 << 20) pings += std::string("\4\7\4PING\0\0", 9);
      while (::send(client_, pings.data(), pings.size(), MSG_NOSIGNAL) > 0) {
      }
    });
    EXPECT_FALSE(stream.receive(10ms));
    EXPECT_FALSE(stream.receive(200ms));
  }  // nor is it when the stream ends
  server.join();
}

TEST_P(PlainStreams, ExchangeMessages) {
  listen();
  PlainStream stream(endpoint());
  send(stream, "early");  // before the handshake
  shake_hands(stream);
  EXPECT_EQ(read(7), frame("early"));
  write(frame("one") + frame("two"));
  ASSERT_TRUE(stream.receive(hang));
  EXPECT_EQ(stream.content(), "one");
  EXPECT_FALSE(stream.has_more());
  ASSERT_TRUE(stream.receive(0ms));
  EXPECT_EQ(stream.content(), "two");
  EXPECT_FALSE(stream.receive(0ms));
}

TEST_P(PlainStreams, TakeFramesThatArriveByteByByte) {
  listen();
  PlainStream stream(endpoint());
  shake_hands(stream);
  const std::string text(300, 'x');
  const std::string bytes = frame(text);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    ASSERT_FALSE(stream.receive(0ms)) << i;
    write(bytes.substr(i, 1));
  }
  ASSERT_TRUE(stream.receive(hang));
  EXPECT_EQ(stream.content(), text);
}

TEST_P(PlainStreams, CarryMegabytesInBothDirections) {
  listen();
  PlainStream stream(endpoint());
  shake_hands(stream);
  std::string large(5'000'000, 'a');
  large.back() = 'z';
  send(stream, large);
  std::thread server([&] {
    EXPECT_TRUE(read(large.size() + 9) == frame(large));
    write(frame(large));
  });
  EXPECT_TRUE(stream.receive(20'000ms));
  EXPECT_TRUE(stream.content() == large);
  server.join();
}

TEST_P(PlainStreams, AnswerPings) {
  listen();
  PlainStream stream(endpoint());
  shake_hands(stream);
  write(std::string("\4\12\4PING\0\1abc", 12));
  EXPECT_FALSE(stream.receive(50ms));
  EXPECT_EQ(read(10), std::string("\4\10\4PONGabc", 10));
}

TEST_P(PlainStreams, WaitForAServerThatStartsLater) {
  PlainStream stream(endpoint());
  EXPECT_FALSE(stream.receive(60ms));
  send(stream, "hello");
  listen();
  EXPECT_FALSE(stream.receive(200ms));
  shake_hands(stream);
  EXPECT_EQ(read(7), frame("hello"));
}

TEST_P(PlainStreams, TryAgainUntilTheyAreOpen) {
  listen();
  PlainStream stream(endpoint());
  accept();
  ::close(client_);
  EXPECT_FALSE(stream.receive(200ms));
  EXPECT_FALSE(stream.was_closed());
  shake_hands(stream);
  EXPECT_TRUE(stream.is_accepted());
  write(frame("last"));
  ::close(std::exchange(client_, -1));
  ASSERT_TRUE(stream.receive(hang));
  EXPECT_EQ(stream.content(), "last");
  EXPECT_FALSE(stream.receive(5000ms));
  EXPECT_TRUE(stream.was_closed());
  EXPECT_FALSE(stream.is_accepted());
}

TEST_P(PlainStreams, CloseWhatIsNoServer) {
  for (const std::string& wrong :
       {std::string("HTTP/1.1 400 Bad Request\r\n\r\n") + std::string(64, ' '),
        greeting() + frame("too early"), greeting() + ready() + "\x7f\x01x",
        greeting() + ready() + std::string("\2\xff\xff\xff\xff\xff\xff\xff\xff", 9),
        greeting() + ready() + std::string("\2\0\0\0\0\x40\x10\0\1", 9)}) {  // longest_message + 1
    listen();
    PlainStream stream(endpoint());
    accept();
    write(wrong);
    EXPECT_FALSE(stream.receive(100ms));
    EXPECT_EQ(stream.was_closed(), wrong.starts_with(greeting() + ready()));
    while (read(1) != "closed") {
    }
    ::close(std::exchange(client_, -1));
    ::close(std::exchange(listener_, -1));
    std::filesystem::remove(path_);
  }
}

TEST_P(PlainStreams, SendTheLastMessagesBeforeTheEnd) {
  listen();
  const std::string large(3'000'000, 'x');
  std::thread server;
  {
    PlainStream stream(endpoint());
    shake_hands(stream);
    send(stream, large);
    send(stream, "bye");
    stream.linger();
    server = std::thread([&] {
      EXPECT_TRUE(read(large.size() + 9) == frame(large));
      EXPECT_EQ(read(5), frame("bye"));
    });
  }
  server.join();
}

TEST_P(PlainStreams, RefuseWhoIsNoRouter) {
  listen();
  PlainStream stream(endpoint());
  accept();
  std::string itself = ready();
  itself.replace(itself.size() - 6, 6, "DEALER");  // as a port that connects to itself
  write(greeting() + itself + frame("too early"));
  EXPECT_FALSE(stream.receive(300ms));
  EXPECT_FALSE(stream.was_closed());
  shake_hands(stream);  // at the next try
}

TEST_P(PlainStreams, TakeOneFrameOfAMessageWithoutEnd) {
  listen();
  PlainStream stream(endpoint());
  shake_hands(stream);
  std::size_t sent = 0;  // [bytes]
  std::string frames;
  while (frames.size() < 1 << 20) frames += std::string("\1\7", 2) + "a frame";
  const auto end = std::chrono::steady_clock::now() + hang;
  for (unsigned full = 0; full < 10 && std::chrono::steady_clock::now() < end;) {
    const ssize_t count = ::send(client_, frames.data(), frames.size() / 9 * 9, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count > 0) sent += static_cast<std::size_t>(count);
    if (count > 0) continue;
    ++full;
    std::this_thread::sleep_for(10ms);  // it could read meanwhile
    if (full > 1) continue;
    ASSERT_TRUE(stream.receive(hang));
    EXPECT_EQ(stream.content(), "a frame");
    EXPECT_TRUE(stream.has_more());
  }
  EXPECT_LT(sent, std::size_t{64} << 20) << "what the kernel keeps, but no more is read";
}

TEST_P(PlainStreams, SendingWaitsWhileTooMuchIsQueued) {
  listen();
  const std::string large(std::size_t{40} << 20, 'x');  // [bytes]; two of them fill the queue
  PlainStream stream(endpoint());
  send(stream, large);
  send(stream, large);
  std::atomic<bool> is_sent = false, is_read = false;
  std::thread client([&] {
    send(stream, "waits");
    is_sent = true;
    while (!is_read) stream.receive(10ms);
  });
  accept();
  write(greeting() + ready());
  std::this_thread::sleep_for(200ms);  // elapsed time is the subject
  EXPECT_FALSE(is_sent);
  const std::string header = read(66);
  read(static_cast<unsigned char>(header.back()));
  EXPECT_TRUE(read(large.size() + 9) == frame(large));
  EXPECT_TRUE(comes_true([&] { return is_sent.load(); }));  // the other thread may not have run since
  EXPECT_TRUE(read(large.size() + 9) == frame(large));
  is_read = true;
  client.join();
  send(stream, large);
  send(stream, large);
  // The end of a server that reads nothing is the end of the wait.
  ::close(std::exchange(client_, -1));
  EXPECT_THROW(send(stream, "and again"), ConnectionError);
}

TEST_P(PlainStreams, TellTheSenderThatTheEndpointIsProtected) {
  listen();
  PlainStream stream(endpoint());
  accept();
  write(greeting().replace(12, 5, "CURVE"));
  const auto send_for_long = [&] {
    comes_true([&] {
      send(stream, "x");
      return false;
    });
  };
  EXPECT_THROW(send_for_long(), ConnectionError);
}

INSTANTIATE_TEST_SUITE_P(Over, PlainStreams, testing::Bool(),
                         [](const auto& is_tcp) { return std::string(is_tcp.param ? "Tcp" : "Path"); });

TEST(PlainEndpoints, ArePathsAndPortsOfHostsWithoutKeys) {
  SessionOptions options;
  const auto is_plain = [&](const std::string& endpoint) {
    options.endpoint = endpoint;
    return PlainEndpoint::of(options).has_value();
  };
  for (const char* plain : {"ipc:///tmp/a", "tcp://127.0.0.1:1", "tcp://a-host.example:65535", "tcp://[::1]:1",
                            "tcp://[fe80::1%eth0]:1"}) {
    EXPECT_TRUE(is_plain(plain)) << plain;
  }
  for (const std::string& other :
       {std::string("ipc://"), std::string("ipc://@abstract"), "ipc:///" + std::string(200, 'x'), std::string("tcp://"),
        std::string("tcp://:1"), std::string("tcp://*:1"), std::string("tcp://host"), std::string("tcp://host:0"),
        std::string("tcp://host:65536"), std::string("tcp://host:1x"), std::string("tcp://::1:1"),
        std::string("tcp://127.0.0.1:0;127.0.0.1:1"), std::string("udp://host:1")}) {
    EXPECT_FALSE(is_plain(other)) << other;
  }
  options.server_key = std::string(40, 'x');
  EXPECT_FALSE(is_plain("ipc:///tmp/a"));
  EXPECT_FALSE(is_plain("tcp://127.0.0.1:1"));
}

TEST(PlainEndpoints, HaveAnAddress) {
  SessionOptions options;
  const auto family_of = [&](const char* endpoint) {
    options.endpoint = endpoint;
    const SocketAddress address = PlainEndpoint::of(options).value().address().get();
    return address.size > 0 ? int{address.bytes.ss_family} : -1;
  };
  EXPECT_EQ(family_of("ipc:///tmp/a"), AF_UNIX);
  EXPECT_EQ(family_of("tcp://127.0.0.1:1"), AF_INET);
  EXPECT_EQ(family_of("tcp://[::1]:1"), AF_INET6);
  EXPECT_EQ(family_of("tcp://localhost:1"), AF_INET) << "looked up";
  EXPECT_EQ(family_of("tcp://no-such-host.invalid:1"), -1);
}

}  // namespace
}  // namespace ziggurat
