// The client's end of ZeroMQ's wire protocol, against a socket on which the test writes the bytes.

#include "local_stream.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <thread>
#include <utility>

namespace ziggurat {
namespace {

using namespace std::chrono_literals;

class LocalStreams : public testing::Test {
 protected:
  LocalStreams() {
    options_.endpoint = "ipc://" + path_;
    std::filesystem::remove(path_);
  }
  ~LocalStreams() override {
    for (const int open : {client_, listener_}) {
      if (open >= 0) ::close(open);
    }
    std::filesystem::remove(path_);
  }

  void listen() {
    listener_ = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strcpy(address.sun_path, path_.c_str());
    ASSERT_EQ(::bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
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
  void shake_hands(LocalStream& stream) {
    accept();
    write(greeting() + ready());
    EXPECT_FALSE(stream.receive(10ms));
    EXPECT_EQ(read(64), greeting());
    const std::string header = read(2);
    ASSERT_EQ(header[0], 4);
    EXPECT_EQ(read(static_cast<unsigned char>(header[1])).substr(0, 6), "\5READY");
  }
  static void send(LocalStream& stream, const std::string& text) {
    stream.send(text.size(), [&](char* to) { std::memcpy(to, text.data(), text.size()); });
  }

  std::string path_ = testing::TempDir() + "local_stream_" + std::to_string(::getpid());
  Options options_;
  int listener_ = -1, client_ = -1;
};

TEST_F(LocalStreams, AServerThatNeverStopsWithCommandsIsNotListenedToWithoutEnd) {
  listen();
  std::thread server;
  {
    LocalStream stream(options_);
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

TEST_F(LocalStreams, AreForPathsWithoutKeys) {
  EXPECT_EQ(LocalStream::path_of(options_), path_);
  options_.server_key = std::string(40, 'x');
  EXPECT_FALSE(LocalStream::path_of(options_));
  options_ = {};
  for (const std::string& other :
       {std::string("ipc://"), std::string("ipc://@abstract"), std::string("tcp://127.0.0.1:1"),
        "ipc:///" + std::string(200, 'x')}) {
    options_.endpoint = other;
    EXPECT_FALSE(LocalStream::path_of(options_)) << other;
  }
}

TEST_F(LocalStreams, ExchangeMessages) {
  listen();
  LocalStream stream(options_);
  send(stream, "early");  // before the handshake
  shake_hands(stream);
  EXPECT_EQ(read(7), frame("early"));
  write(frame("one") + frame("two"));
  ASSERT_TRUE(stream.receive(5000ms));
  EXPECT_EQ(stream.content(), "one");
  EXPECT_FALSE(stream.has_more());
  ASSERT_TRUE(stream.receive(0ms));
  EXPECT_EQ(stream.content(), "two");
  EXPECT_FALSE(stream.receive(0ms));
}

TEST_F(LocalStreams, TakeFramesThatArriveByteByByte) {
  listen();
  LocalStream stream(options_);
  shake_hands(stream);
  const std::string text(300, 'x');
  const std::string bytes = frame(text);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    ASSERT_FALSE(stream.receive(0ms)) << i;
    write(bytes.substr(i, 1));
  }
  ASSERT_TRUE(stream.receive(5000ms));
  EXPECT_EQ(stream.content(), text);
}

TEST_F(LocalStreams, CarryMegabytesInBothDirections) {
  listen();
  LocalStream stream(options_);
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

TEST_F(LocalStreams, AnswerPings) {
  listen();
  LocalStream stream(options_);
  shake_hands(stream);
  write(std::string("\4\12\4PING\0\1abc", 12));
  EXPECT_FALSE(stream.receive(50ms));
  EXPECT_EQ(read(10), std::string("\4\10\4PONGabc", 10));
}

TEST_F(LocalStreams, WaitForAServerThatStartsLater) {
  LocalStream stream(options_);
  EXPECT_FALSE(stream.receive(60ms));
  send(stream, "hello");
  listen();
  EXPECT_FALSE(stream.receive(200ms));
  shake_hands(stream);
  EXPECT_EQ(read(7), frame("hello"));
}

TEST_F(LocalStreams, TryAgainUntilTheyAreOpen) {
  listen();
  LocalStream stream(options_);
  accept();
  ::close(client_);
  EXPECT_FALSE(stream.receive(200ms));
  EXPECT_FALSE(stream.was_closed());
  shake_hands(stream);
  EXPECT_TRUE(stream.is_accepted());
  write(frame("last"));
  ::close(std::exchange(client_, -1));
  ASSERT_TRUE(stream.receive(5000ms));
  EXPECT_EQ(stream.content(), "last");
  EXPECT_FALSE(stream.receive(5000ms));
  EXPECT_TRUE(stream.was_closed());
  EXPECT_FALSE(stream.is_accepted());
}

TEST_F(LocalStreams, CloseWhatIsNoServer) {
  for (const std::string& wrong :
       {std::string("HTTP/1.1 400 Bad Request\r\n\r\n") + std::string(64, ' '),
        greeting() + frame("too early"), greeting() + ready() + "\x7f\x01x",
        greeting() + ready() + std::string("\2\xff\xff\xff\xff\xff\xff\xff\xff", 9),
        greeting() + ready() + std::string("\2\0\0\0\0\x40\x10\0\1", 9)}) {  // longest_message + 1
    listen();
    LocalStream stream(options_);
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

TEST_F(LocalStreams, SendTheLastMessagesBeforeTheEnd) {
  listen();
  const std::string large(3'000'000, 'x');
  std::thread server;
  {
    LocalStream stream(options_);
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

}  // namespace
}  // namespace ziggurat
