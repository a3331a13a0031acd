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
}

TEST(Metrics, AreServedOverHttp) {
  MetricsPort port("127.0.0.1:0", false);
  httplib::Client client(port.url());
  EXPECT_TRUE(port.is_due());
  port.publish(status());
  EXPECT_FALSE(port.is_due());
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

}  // namespace
}  // namespace ziggurat::reports
