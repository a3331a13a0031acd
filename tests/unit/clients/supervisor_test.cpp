// SPDX-License-Identifier: MIT
// Supervisor against a server that the test scripts.

#include "ziggurat/supervisor.h"

#include <gtest/gtest.h>

#include "fake_server.h"
#include "words_of.h"
#include "ziggurat/error.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat {
namespace {

SupervisorOptions supervise(const FakeServer& server) {
  SupervisorOptions options;
  options.endpoint = server.endpoint;
  options.connect_timeout = std::chrono::milliseconds{20'000};
  options.answer_timeout = std::chrono::milliseconds{20'000};
  return options;
}

v1::ServerMessage answer(const v1::ClientMessage& question) {
  v1::ServerMessage message;
  message.mutable_response()->set_id(question.request().id());
  return message;
}

TEST(Supervisor, ListsTheSessions) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    auto message = answer(self.receive());
    v1::Status& status = *message.mutable_response()->mutable_status();
    status.set_tick(7);
    status.set_phase(v1::Status::RUNNING);
    v1::SessionStatus& session = *status.add_sessions();
    session.set_role(v1::ROLE_OBSERVER);
    session.set_state(v1::SessionStatus::OWING);
    session.add_robots("a");
    v1::SolverStatus& solver = *status.mutable_solver();
    solver.set_islands(1000);
    solver.set_not_converged(3);
    solver.set_worst_residual(0.25);
    self.send(message);
  });
  Supervisor supervisor(supervise(server));
  const ServerStatus status = supervisor.status();
  EXPECT_EQ(status.tick, 7U);
  EXPECT_EQ(status.phase, "running");
  ASSERT_EQ(status.sessions.size(), 1U);
  EXPECT_EQ(status.sessions[0].role, "observer");
  EXPECT_EQ(status.sessions[0].state, "owing");
  EXPECT_EQ(status.sessions[0].robots, std::vector<std::string>{"a"});
  EXPECT_EQ(status.solver.islands, 1000U);
  EXPECT_EQ(status.solver.not_converged, 3U);
  EXPECT_EQ(status.solver.worst_residual, 0.25);
  EXPECT_NE(supervisor.last_answer_json().find("ROLE_OBSERVER"), std::string::npos);
}

TEST(Supervisor, SetsAJoint) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    const v1::ClientMessage question = self.receive();
    const v1::SetJointRequest& set = question.request().set_joint();
    EXPECT_EQ(set.entity() + "." + set.joint(), "arm.hinge");
    EXPECT_EQ(set.position(), 0.5);
    EXPECT_EQ(set.velocity(), -2);
    auto message = answer(question);
    message.mutable_response()->set_tick(7);
    self.send(message);
  });
  Supervisor supervisor(supervise(server));
  EXPECT_EQ(supervisor.set_joint("arm", "hinge", 0.5, -2), 7U);
}

TEST(Supervisor, HeartbeatsDoNotExtendTheTimeOut) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    self.receive();
    v1::ServerMessage message;
    message.mutable_heartbeat()->set_sequence(1);
    for (int i = 0; i < 60; ++i) {  // 3 s
      self.send(message);
      std::this_thread::sleep_for(std::chrono::milliseconds{50});  // elapsed time is the subject
    }
    v1::ClientMessage late;
    late.mutable_request()->set_id(1);
    self.send(answer(late));
  });
  SupervisorOptions options = supervise(server);
  options.answer_timeout = std::chrono::milliseconds{200};
  Supervisor supervisor(options);
  EXPECT_TRUE(fails_with<ConnectionError>("after 200 ms", [&] { supervisor.pause(); }));
}

TEST(Supervisor, ServersOfLaterVersionsMayHaveMoreRoles) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    auto message = answer(self.receive());
    auto& session = *message.mutable_response()->mutable_status()->add_sessions();
    session.set_role(static_cast<v1::Role>(77));
    session.set_state(static_cast<v1::SessionStatus::State>(77));
    self.send(message);
  });
  Supervisor supervisor(supervise(server));
  EXPECT_EQ(supervisor.status().sessions.at(0).role, "role 77");
}

TEST(Supervisor, WaitsForTheAnswerToItsOwnRequest) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    auto message = answer(self.receive());
    const auto id = message.response().id();
    message.mutable_response()->set_id(id + 1);
    message.mutable_response()->set_tick(1);
    self.send(message);
    message.mutable_response()->set_id(id);
    message.mutable_response()->set_tick(2);
    self.send(message);
  });
  Supervisor supervisor(supervise(server));
  EXPECT_EQ(supervisor.pause(), 2U);
}

TEST(Supervisor, ARefusedRequestIsAnException) {
  FakeServer server([](FakeServer& self) {
    self.welcome();
    auto message = answer(self.receive());
    message.mutable_response()->mutable_error()->set_code(v1::Error::UNKNOWN_ENTITY);
    self.send(message);
  });
  Supervisor supervisor(supervise(server));
  try {
    supervisor.remove("unknown");
    FAIL() << "nothing was thrown";
  } catch (const ProtocolError& error) {
    EXPECT_EQ(error.details().code, "UNKNOWN_ENTITY");
  }
}

}  // namespace
}  // namespace ziggurat
