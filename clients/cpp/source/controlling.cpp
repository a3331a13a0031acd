// SPDX-License-Identifier: MIT
#include "controlling.h"

#include <algorithm>

#include "ziggurat/error.h"
#include "ziggurat/v1/envelope.h"

namespace ziggurat {

void Controlling::ask(v1::Hello& hello) const {
  hello.set_role(v1::ROLE_CONTROLLER);
  for (const std::string& robot : options_.robots) hello.add_robots(v1::valid_utf8(robot));
  hello.set_controller(v1::valid_utf8(options_.controller));
  hello.set_lua_only(options_.lua_only);
  if (options_.name.empty()) {
    const bool has_id = !options_.controller.empty();
    hello.set_client_name(has_id ? v1::valid_utf8(options_.controller) : std::string("controller"));
  }
  if (options_.robots.empty() && options_.controller.empty() && !options_.lua_only) {
    hello.add_robots("*");
  }
  hello.set_takeover(options_.takeover);
}

void Controlling::begin(const v1::Welcome& welcome) {
  fleet_.emplace(welcome);
  fleet_->resume(welcome.resumed().commanded());
  fleet_->remove(welcome.resumed().gone_robots());
}

/// The session has the robots that it had, in their order (H9): their handles stay.
void Controlling::go_on(const v1::Welcome& welcome, std::vector<v1::Leave>& failures) {
  const auto robots = fleet_->robots();
  const bool are_the_same =
      std::equal(robots.begin(), robots.end(), welcome.robots().begin(), welcome.robots().end(),
                 [](const Robot& ours, const v1::RobotDescription& theirs) {
                   return ours.id() == theirs.id();
                 });
  if (!are_the_same) throw ProtocolError("the resumed session has other robots than before", {});
  fleet_->remove(welcome.resumed().gone_robots());
  std::erase_if(failures, [&](const v1::Leave& leave) { return robots[leave.robots(0)].gone(); });
}

std::optional<Moment> Controlling::moment(Connection::Kind kind, const Connection& from) const {
  if (kind != Connection::Kind::kObservation) return std::nullopt;
  const v1::Observation& observation = from.observation();
  Moment moment{observation.tick(), observation.time_ns(), {}};
  if (observation.has_epoch()) moment.epoch = observation.epoch();
  return moment;
}

/// A robot was removed from the world, or another client has taken it over.
void Controlling::warn(const v1::Error& error) {
  if (error.code() == v1::Error::NOT_YOURS) fleet_->remove(error.robot());
}

void Controlling::hear(Connection::Kind kind, const v1::ServerMessage& message) {
  constexpr std::size_t most = 10'000;  // a client that does not ask for them keeps no more
  if (kind != Connection::Kind::kRobotSpawned || spawned_.size() == most) return;
  const v1::RobotSpawned& robot = message.robot_spawned();
  spawned_.push_back({robot.robot(), robot.controller(), robot.tick()});
}

void Controlling::write(v1::ClientMessage& answer, const Moment& moment) {
  v1::Command& command = *answer.mutable_command();
  command.Clear();
  command.set_tick(moment.tick);
  if (moment.epoch) command.set_epoch(*moment.epoch);
  fleet_->write(command);
}

void Controlling::write(v1::Leave& leave) {
  fleet_->move_log_to(*leave.mutable_log());
  fleet_->move_metrics_to(*leave.mutable_metrics());
}

}  // namespace ziggurat
