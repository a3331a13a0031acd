#include "http/port.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <stdexcept>

namespace ziggurat::http {
namespace {

Answer read(std::string_view path) {
  return {path == "/" ? 200u : 404u, "text/plain", {}, "0123456789"};
}

std::string answer(const std::string& request) {
  return answer_at_port(request, "127.0.0.1", false, read);
}

TEST(Port, AnswersHeadWithoutTheText) {
  const std::string whole = answer("GET / HTTP/1.1\r\n\r\n"), head = answer("HEAD / HTTP/1.1\r\n\r\n");
  EXPECT_TRUE(whole.ends_with("\r\n\r\n0123456789")) << whole;
  EXPECT_TRUE(head.ends_with("\r\n\r\n")) << head;
  EXPECT_NE(head.find("Content-Length: 10\r\n"), std::string::npos) << head;
}

TEST(Port, EndsTheConnectionAfterAnAnswer) {
  EXPECT_NE(answer("GET / HTTP/1.1\r\n\r\n").find("Connection: close\r\n"), std::string::npos);
}

TEST(Port, TellsWhatIsWrongWithARequest) {
  EXPECT_TRUE(answer("GET / HTTP/1.1\r\nX: " + std::string(9000, 'x')).starts_with("HTTP/1.1 431"));
  EXPECT_TRUE(answer("GET / HTTP/1.1\r\nno colon\r\n\r\n").starts_with("HTTP/1.1 400"));
  EXPECT_TRUE(answer(std::string(3, '\0')).starts_with("HTTP/1.1 400"));
}

/// Sends a request to a port of this machine, and waits for the end of the answer.
void ask(std::uint16_t port, const std::string& request) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int client = ::socket(AF_INET, SOCK_STREAM, 0);
  EXPECT_EQ(::connect(client, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
  EXPECT_EQ(::send(client, request.data(), request.size(), MSG_NOSIGNAL), static_cast<ssize_t>(request.size()));
  std::array<char, 1000> answer;
  while (::recv(client, answer.data(), answer.size(), 0) > 0) {
  }
  ::close(client);
}

TEST(Port, ItsThreadIsLessImportantThanOthers) {
  const int ours = ::getpriority(PRIO_PROCESS, 0);  // of this thread
  std::atomic<int> theirs = ours;
  const auto note = [&](std::string_view) {
    theirs = ::getpriority(PRIO_PROCESS, 0);
    return Answer{};
  };
  const Port port("--metrics", {"127.0.0.1", 0}, false, note);
  ask(port.number(), "GET / HTTP/1.1\r\n\r\n");
  EXPECT_EQ(theirs, std::min(ours + 5, 19));
  EXPECT_EQ(::getpriority(PRIO_PROCESS, 0), ours);
}

TEST(Port, ATakenAddressIsAnErrorThatNamesTheOption) {
  const Port first("--metrics", {"127.0.0.1", 0}, false, read);
  try {
    const Port second("--metrics", {"127.0.0.1", first.number()}, false, read);
    FAIL() << "it is taken";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).find("--metrics: 127.0.0.1:"), 0u) << error.what();
  }
}

}  // namespace
}  // namespace ziggurat::http
