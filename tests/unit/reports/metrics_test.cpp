// SPDX-License-Identifier: MIT
#include "reports/metrics.h"

#include <gtest/gtest.h>
#include <httplib.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "http/port.h"
#include "posix/descriptor.h"
#include "text/numbers.h"

namespace ziggurat::reports {
namespace {

wire::Status status() {
  wire::Status result;
  result.tick = 42;
  result.time_ns = 4'200'000'000;
  result.phase = wire::Status::Phase::running;
  result.free_robots = {"r7"};
  wire::SessionStatus session;
  session.client = "we \"quote\"\n";
  session.state = wire::SessionStatus::State::owing;
  session.wall_waiting_s = 1.5;
  session.misses = 3;
  result.sessions = {session};
  result.budget = {{"physics", {0.001, 0.002, 0.003}}};
  return result;
}

TEST(Metrics, ReadAsPrometheusAsks) {
  const std::string text = to_prometheus(status());
  EXPECT_NE(text.find("\nziggurat_tick 42\n"), std::string::npos);
  EXPECT_NE(text.find("ziggurat_session_waiting_seconds{session=\"0\","
                      "client=\"we \\\"quote\\\"\\n\"} 1.5\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("phase=\"physics\",quantile=\"0.99\"} 0.002\n"), std::string::npos);
  EXPECT_EQ(text.find("solver"), std::string::npos);
}

TEST(Metrics, TellHowWellTheSolverDid) {
  wire::Status solved = status();
  solved.solver = {1000, 3, 0.25};
  const std::string text = to_prometheus(solved);
  EXPECT_NE(text.find("\nziggurat_solver_islands 1000\n"), std::string::npos);
  EXPECT_NE(text.find("\nziggurat_solver_not_converged 3\n"), std::string::npos);
  EXPECT_NE(text.find("\nziggurat_solver_worst_residual 0.25\n"), std::string::npos);
}

TEST(Metrics, AreServedOverHttp) {
  MetricsPort port("127.0.0.1:0", false);
  httplib::Client client(port.url());
  EXPECT_TRUE(port.needs_update());
  port.publish(status());
  EXPECT_FALSE(port.needs_update());
  const auto metrics = client.Get("/metrics");
  ASSERT_TRUE(metrics);
  EXPECT_EQ(metrics->body, to_prometheus(status()));
  const auto json = client.Get("/status");
  ASSERT_TRUE(json);
  EXPECT_EQ(nlohmann::json::parse(json->body)["sessions"][0]["state"], "OWING");
  EXPECT_EQ(client.Get("/secret")->status, 404);
}

// ---- clients that are slow, many or rude --------------------------------------------------------

posix::Descriptor connect_to(const MetricsPort& port) {
  const std::string url = port.url();
  posix::Descriptor client(::socket(AF_INET, SOCK_STREAM, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1))));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(::connect(client.number(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  return client;
}

/// Sends a text and returns the whole answer.
std::string ask(const MetricsPort& port, const std::string& text) {
  const posix::Descriptor client = connect_to(port);
  ::send(client.number(), text.data(), text.size(), MSG_NOSIGNAL);
  std::string answer, part(65536, '\0');
  for (;;) {
    const ssize_t size = ::recv(client.number(), part.data(), part.size(), 0);
    if (size <= 0) return answer;
    answer.append(part, 0, static_cast<std::size_t>(size));
  }
}

TEST(Metrics, SlowClientsBlockNeitherOthersNorTheEnd) {
  std::vector<posix::Descriptor> slow;
  const auto begin = std::chrono::steady_clock::now();
  {
    MetricsPort port("127.0.0.1:0", false);
    port.publish(status());
    for (int i = 0; i < 100; ++i) {
      slow.push_back(connect_to(port));
      ::send(slow.back().number(), "GET /met", 8, MSG_NOSIGNAL);
    }
    EXPECT_TRUE(
        ask(port, "GET /metrics HTTP/1.1\r\nHost: localhost\r\n\r\n").starts_with("HTTP/1.1 200"));
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, http::PortOptions().time)
      << "which slow ones have";
}

TEST(Metrics, LongRequestsAreRefused) {
  MetricsPort port("127.0.0.1:0", false);
  std::string line = "GET /" + std::string(20'000, 'x');
  EXPECT_NE(ask(port, line).find("431"), 0U);
  const std::string long_header = "GET / HTTP/1.1\r\nX: " + std::string(8150, 'x');
  ASSERT_LT(long_header.size(), 8192U);
  EXPECT_TRUE(ask(port, long_header + std::string(8192 - long_header.size(), 'x'))
                  .starts_with("HTTP/1.1 431"));
}

TEST(Metrics, AnswersAreWholeForThisMachineAndForGetOnly) {
  const auto read = [](std::string_view path) {
    return http::Answer{path == "/" ? 200u : 404u, "text/plain", {}, "0123456789"};
  };
  const auto code = [&](const std::string& request) {
    return http::answer_at_port(request, "127.0.0.1", read).substr(9, 3);
  };
  EXPECT_EQ(code("GET / HTTP/1.0\r\n\r\n"), "200");
  const std::string ranges = "Range: bytes=0-1,0-1,0-1,0-1\r\n";
  const auto whole =
      http::answer_at_port("GET / HTTP/1.1\r\nHost: [::1]:80\r\n" + ranges + "\r\n", "x", read);
  EXPECT_TRUE(whole.starts_with("HTTP/1.1 200") && whole.ends_with("\r\n\r\n0123456789")) << whole;
  for (const auto* host : {"localhost:1", "LocalHost", "127.0.0.1", "[::1]", " 10.0.0.1:9464 "}) {
    EXPECT_EQ(code(std::string("GET / HTTP/1.1\r\nhost:") + host + "\r\n\r\n"), "200") << host;
  }
  EXPECT_EQ(code("GET / HTTP/1.1\r\nHost: rebound.example:9464\r\n\r\n"), "403");
  EXPECT_TRUE(http::answer_at_port("GET / HTTP/1.1\r\nHost: monitor.example\r\n\r\n", "x", read,
                                   {.any_host = true})
                  .starts_with("HTTP/1.1 200"));
  EXPECT_EQ(code("POST / HTTP/1.1\r\nContent-Length: 99999999999\r\n\r\n"), "405");
  EXPECT_EQ(code("GET /other HTTP/1.1\r\n\r\n"), "404");
  EXPECT_EQ(code("GET /?a=b HTTP/1.1\r\n\r\n"), "200");
  for (const auto* bad : {"\r\n\r\n", "GET\r\n\r\n", "GET /\r\n\r\n", "GET / SSH-2\r\n\r\n"}) {
    EXPECT_EQ(code(bad), "400") << bad;
  }
}

TEST(Metrics, StayOnThisMachineUnlessTold) {
  EXPECT_THROW(MetricsPort("0.0.0.0:0", false), text::UsageError);
  EXPECT_NO_THROW(MetricsPort("0.0.0.0:0", true));
  EXPECT_THROW(MetricsPort("9464", false), text::UsageError);
  EXPECT_THROW(MetricsPort("127.0.0.1:99999", false), text::UsageError);
}

TEST(Metrics, TakeAnAddressOfThisMachineWithAFreePort) {
  const MetricsPort first("127.0.0.1:0", false);
  EXPECT_THROW(MetricsPort(first.url().substr(7), false), std::runtime_error) << "taken";
  EXPECT_THROW(MetricsPort("192.0.2.1:0", true), std::runtime_error) << "of no machine";
}

TEST(Metrics, TakeAnIpv6AddressInBrackets) {
  httplib::Server server;
  if (server.bind_to_any_port("::1") < 0) GTEST_SKIP() << "this machine has no IPv6 loopback";
  EXPECT_NO_THROW(MetricsPort("[::1]:0", false));
}

}  // namespace
}  // namespace ziggurat::reports
