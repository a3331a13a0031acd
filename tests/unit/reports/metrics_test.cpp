#include "reports/metrics.h"

#include <gtest/gtest.h>
#include <httplib.h>

#include <nlohmann/json.hpp>

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
