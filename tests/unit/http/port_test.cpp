// SPDX-License-Identifier: MIT
#include "http/port.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "http/listening.h"
#include "waiting.h"
#include "words_of.h"

namespace ziggurat::http {
namespace {

Answer read(std::string_view path) {
  return {path == "/" ? 200u : 404u, "text/plain", {}, "0123456789"};
}

std::string answer(const std::string& request) {
  return answer_at_port(request, "127.0.0.1", read);
}

TEST(Port, AnswersHeadWithoutTheText) {
  const std::string whole = answer("GET / HTTP/1.1\r\n\r\n"),
                    head = answer("HEAD / HTTP/1.1\r\n\r\n");
  EXPECT_TRUE(whole.ends_with("\r\n\r\n0123456789")) << whole;
  EXPECT_TRUE(head.ends_with("\r\n\r\n")) << head;
  EXPECT_NE(head.find("Content-Length: 10\r\n"), std::string::npos) << head;
}

TEST(Port, GivesGzipToThoseThatTakeIt) {
  const auto read_page = [](std::string_view) {
    Answer page{200, "text/plain", "\"tag\"", "0123456789"};
    page.gzipped = "zip";
    return page;
  };
  const auto asked = [&](const std::string& accepted) {
    return answer_at_port("GET / HTTP/1.1\r\nAccept-Encoding: " + accepted + "\r\n\r\n",
                          "127.0.0.1", read_page);
  };
  for (const char* accepted : {"gzip", "br, GZIP;q=0.5, deflate", "gzip;q=0.001", "gzip;level=1"}) {
    const std::string page = asked(accepted);
    EXPECT_TRUE(page.ends_with("\r\n\r\nzip")) << page;
    EXPECT_NE(page.find("Content-Encoding: gzip\r\n"), std::string::npos) << page;
    EXPECT_NE(page.find("Content-Length: 3\r\n"), std::string::npos) << page;
  }
  for (const char* accepted : {"", "br", "gzip;q=0", "gzip;q=0.000", "xgzip", "deflate;x=gzip"}) {
    const std::string page = asked(accepted);
    EXPECT_TRUE(page.ends_with("\r\n\r\n0123456789")) << page;
    EXPECT_EQ(page.find("Content-Encoding"), std::string::npos) << page;
    EXPECT_NE(page.find("Vary: Accept-Encoding\r\n"), std::string::npos) << page;
  }
}

TEST(Port, TellsHowLongAnAnswerStays) {
  Answer given{200, "text/plain", {}, "0123456789"};
  const auto told = [&](const char* what) {
    return answer_at_port("GET / HTTP/1.1\r\n\r\n", "127.0.0.1", [&](auto) {
             return given;
           }).find(what) != std::string::npos;
  };
  EXPECT_TRUE(told("Cache-Control: no-store\r\n"));
  given.etag = "\"tag\"";
  EXPECT_TRUE(told("Cache-Control: no-cache\r\n"));
  given.is_immutable = true;
  EXPECT_TRUE(told("Cache-Control: public, max-age=31536000, immutable\r\n"));
  EXPECT_FALSE(told("Location"));
  given.location = "/there";
  EXPECT_TRUE(told("Location: /there\r\n"));
}

TEST(Port, SendsToAnotherPortByTheNameThatWasCalled) {
  Answer there{303, "text/plain", {}, ""};
  there.location = "/there";
  there.port = 99;
  for (const auto& [called, place] : {std::pair("Host: 192.0.2.1:8765\r\n", "//192.0.2.1:99/there"),
                                      std::pair("Host: [::1]:8765\r\n", "//[::1]:99/there"),
                                      std::pair("Host: localhost\r\n", "//localhost:99/there"),
                                      std::pair("", "//127.0.0.1:99/there")}) {
    const std::string answer = answer_at_port(std::string("GET / HTTP/1.0\r\n") + called + "\r\n",
                                              "0.0.0.0", [&](auto) { return there; });
    EXPECT_NE(answer.find(std::string("Location: ") + place + "\r\n"), std::string::npos) << answer;
  }
}

TEST(Port, EndsTheConnectionAfterAnAnswer) {
  EXPECT_NE(answer("GET / HTTP/1.1\r\n\r\n").find("Connection: close\r\n"), std::string::npos);
}

TEST(Port, TellsWhatIsWrongWithARequest) {
  EXPECT_TRUE(answer("GET / HTTP/1.1\r\nX: " + std::string(9000, 'x')).starts_with("HTTP/1.1 431"));
  EXPECT_TRUE(answer("GET / HTTP/1.1\r\nno colon\r\n\r\n").starts_with("HTTP/1.1 400"));
  EXPECT_TRUE(answer(std::string(3, '\0')).starts_with("HTTP/1.1 400"));
}

TEST(Port, RefusesWhatAProxyCouldReadOtherwise) {
  for (const char* fields :
       {"Host: localhost\r\nHost: evil.example", "Host: localhost\r\nhost: localhost",
        "Transfer-Encoding: xchunked", "Transfer-Encoding: chunked, gzip",
        "Origin: http://a\r\nOrigin: http://b"}) {
    EXPECT_TRUE(
        answer("GET / HTTP/1.1\r\n" + std::string(fields) + "\r\n\r\n").starts_with("HTTP/1.1 400"))
        << fields;
  }
}

/// A connection to a port of this machine.
class Client {
 public:
  explicit Client(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
  }
  ~Client() { ::close(socket_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void send(const std::string& bytes) {
    EXPECT_EQ(::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
  }

  /// All that comes until the port ends the connection.
  std::string hear() {
    std::string all;
    std::array<char, 1000> part;
    for (ssize_t size; (size = ::recv(socket_, part.data(), part.size(), 0)) > 0;) {
      all.append(part.data(), static_cast<std::size_t>(size));
    }
    return all;
  }

  bool is_open() {
    char byte;
    return ::recv(socket_, &byte, 1, MSG_PEEK | MSG_DONTWAIT) < 0 &&
           (errno == EAGAIN || errno == EWOULDBLOCK);
  }

 private:
  int socket_;
};

TEST(Port, ItsThreadIsLessImportantThanOthers) {
  const int ours = ::getpriority(PRIO_PROCESS, 0);  // of this thread
  std::atomic<int> theirs = ours;
  const auto note = [&](std::string_view) {
    theirs = ::getpriority(PRIO_PROCESS, 0);
    return Answer{};
  };
  const Port port("--metrics", {"127.0.0.1", 0}, note);
  Client client(port.number());
  client.send("GET / HTTP/1.1\r\n\r\n");
  client.hear();
  EXPECT_EQ(theirs, std::min(ours + 5, 19));
  EXPECT_EQ(::getpriority(PRIO_PROCESS, 0), ours);
}

TEST(Port, AClientThatTakesTooLongIsDisconnected) {
  EXPECT_EQ(PortOptions().time, std::chrono::seconds(5));
  const Port port("--metrics", {"127.0.0.1", 0}, read, {.time = std::chrono::milliseconds(50)});
  Client silent(port.number()), slow(port.number());
  slow.send("GET / HTTP/1.1\r\nHost: local");
  EXPECT_EQ(silent.hear(), "");
  EXPECT_EQ(slow.hear(), "");
}

TEST(Port, AClientThatSendsNowAndThenHasNoLongerTime) {
  const Port port("--metrics", {"127.0.0.1", 0}, read, {.time = std::chrono::milliseconds(300)});
  Client slow(port.number());
  slow.send("GET / HTTP/1.1\r\nX: ");
  EXPECT_TRUE(comes_true([&] {
    slow.send("x");
    return !slow.is_open();
  }));
}

TEST(Port, OfTooManyClientsTheOldestMakesPlace) {
  const auto most = static_cast<int>(PortOptions().clients);
  EXPECT_EQ(most, 16);
  const Port port("--metrics", {"127.0.0.1", 0}, read, {.time = std::chrono::hours(1)});
  std::vector<std::unique_ptr<Client>> clients;
  for (int i = 0; i < most + 2; ++i) {
    clients.push_back(std::make_unique<Client>(port.number()));
    clients.back()->send("GET / HTTP/1.1\r\n");
  }
  EXPECT_EQ(clients[0]->hear(), "");
  EXPECT_EQ(clients[1]->hear(), "");
  for (int i = 2; i < most + 2; ++i) {
    clients[i]->send("\r\n");
    EXPECT_TRUE(clients[i]->hear().starts_with("HTTP/1.1 200")) << i;
  }
}

TEST(Port, TakesSoManyConnectionsInAPeriod) {
  const Port port("--metrics", {"127.0.0.1", 0}, read);
  const auto begun = std::chrono::steady_clock::now();
  for (int i = 0; i < 2 * Listening::most_in_period + 1; ++i) {
    Client client(port.number());
    client.send("GET / HTTP/1.1\r\n\r\n");
    EXPECT_NE(client.hear(), "");
  }
  EXPECT_GE(std::chrono::steady_clock::now() - begun,
            Listening::period);  // the first may have been at the end of one
}

TEST(Port, ATakenAddressIsAnErrorThatNamesTheOption) {
  const Port first("--metrics", {"127.0.0.1", 0}, read);
  const std::string words = words_of<std::runtime_error>([&] {
    const Port second("--metrics", {"127.0.0.1", first.number()}, read);
  });
  EXPECT_EQ(words.find("--metrics: 127.0.0.1:"), 0u) << words;
}

}  // namespace
}  // namespace ziggurat::http
