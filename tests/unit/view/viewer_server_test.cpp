// SPDX-License-Identifier: MIT
// The port itself, seen by a client that speaks bytes only.

#include "view/viewer_server.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <string>

#include "text/numbers.h"
#include "words_of.h"

namespace ziggurat::view {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// A connection to the server, after the handshake of a viewer.
class RawViewer {
 public:
  explicit RawViewer(const std::string& address) {
    const std::size_t host = address.find("127.0.0.1:") + 10;
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(std::stoi(address.substr(host))));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socket_ = ::socket(AF_INET, SOCK_STREAM, 0);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
    send(
        "GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"
        "Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n\r\n");
  }
  ~RawViewer() { ::close(socket_); }

  void send(const std::string& bytes) {
    EXPECT_EQ(::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
  }

  /// Reads, and does what it should or not with pings, until the server closes or the time is over.
  /// @return whether the server has closed
  bool is_closed_within(std::chrono::milliseconds time, bool answers) {
    const auto end = Clock::now() + time;
    while (Clock::now() < end) {
      pollfd item{socket_, POLLIN, 0};
      if (::poll(&item, 1, 20) == 1) {
        char bytes[4096];
        if (::recv(socket_, bytes, sizeof bytes, 0) <= 0) return true;
      }
      if (answers) send(std::string("\x8a\x80\0\0\0\0", 6));  // a pong, masked, empty
    }
    return false;
  }

 private:
  int socket_ = -1;
};

TEST(ViewerServer, AViewerThatAnswersNoPingIsDisconnected) {
  Settings settings;
  settings.address = http::Address{"127.0.0.1", 0};
  settings.silence = 400ms;
  ViewerServer server(settings);
  RawViewer silent(server.page_address());
  EXPECT_TRUE(silent.is_closed_within(5s, false));
  RawViewer alive(server.page_address());
  EXPECT_FALSE(alive.is_closed_within(1500ms, true));
}

TEST(ViewerServer, AnOpenAddressNeedsATokenOfTheUserOrConsent) {
  for (const char* host : {"0.0.0.0", "::", "*"}) {
    Settings settings;
    settings.address = http::Address{host, 0};
    EXPECT_TRUE(fails_with<text::UsageError>("--view-token", [&] {
      const ViewerServer server(settings);
    })) << host;
  }
  Settings settings;
  settings.address = http::Address{"0.0.0.0", 0};
  settings.token = "0123456789abcdef";
  EXPECT_TRUE(ViewerServer{settings}.page_address().starts_with("http://127.0.0.1:"));
  settings.token.clear();
  settings.insecure = true;
  EXPECT_NO_THROW(ViewerServer{settings});
}

TEST(ViewerServer, TakesAnotherPortIfTheUsualOneIsTaken) {
  const Settings settings;
  const ViewerServer first(settings), second(settings);
  EXPECT_NE(first.page_address(), second.page_address());
  EXPECT_NE(second.page_address().find("http://127.0.0.1:"), std::string::npos);
  EXPECT_EQ(second.page_address().find(":8765/"), std::string::npos);
}

}  // namespace
}  // namespace ziggurat::view
