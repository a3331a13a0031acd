// SPDX-License-Identifier: MIT
// Our server with a world without physics.

#include <unistd.h>

#include <stdexcept>

#include "lockstep/arena.h"
#include "network/server.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::bench {
namespace {

constexpr std::size_t joints = 4;  // of a robot

world::Layout layout_for(const Setup& setup) {
  world::Layout layout;
  for (std::size_t process = 0; process < setup.processes; ++process) {
    for (std::size_t i = 0; i < setup.robots; ++i) {
      world::RobotLayout robot;
      robot.id = "p" + std::to_string(process) + "_r" + std::to_string(i);
      robot.joint_sensors = {layout.joint_sensors.size(), joints};
      robot.joint_actuators = {layout.joint_actuators.size(), joints};
      for (std::size_t joint = 0; joint < joints; ++joint) {
        const std::string id = "wheel" + std::to_string(joint);
        layout.joint_sensors.push_back({.id = id, .velocity = true});
        layout.joint_actuators.push_back({.id = id, .velocity = true, .max_impulse = 0.005});
      }
      layout.robots.push_back(robot);
    }
  }
  return layout;
}

network::Config config_for(const Setup& setup) {
  network::Config config;
  config.endpoints = {setup.transport == "ipc"
                          ? "ipc://@ziggurat-bench-" + std::to_string(::getpid())
                          : "tcp://127.0.0.1:*"};
  if (setup.keys) {
    network::Roles roles;
    roles.controller = true;
    config.curve = {setup.keys->server_secret, {{setup.keys->client_public, roles, "bench"}}};
  }
  return config;
}

}  // namespace

struct Ours::State {
  explicit State(const Setup& from)
      : setup(from),
        layout(layout_for(from)),
        controllers(1),
        server(config_for(from), {layout, controllers, {}, 1, 100'000'000, 10, "", "bench"}) {}

  Setup setup;
  world::Layout layout;
  std::vector<scene::Controller> controllers;
  network::Server server;
  world::Observations observations;
  std::vector<std::string> tag_payloads;  // none
  world::Commands commands;
  Processes processes;
};

Ours::Ours(const Setup& setup) : state_(std::make_unique<State>(setup)) {
  State& state = *state_;
  state.observations.joint_readings.assign(state.layout.joint_sensors.size(), 0.5);
  state.commands.joint_targets.assign(state.layout.joint_actuators.size(), 0.0);
  for (std::size_t i = 0; i < setup.processes; ++i) {
    std::vector<std::string> arguments{"ziggurat", state.server.endpoints().front(),
                                       "p" + std::to_string(i) + "_*"};
    if (setup.keys) {
      arguments.insert(arguments.end(), {setup.keys->server_public, setup.keys->client_secret});
    }
    state.processes.start(setup.client, arguments);
  }
  if (state.server.gather({std::chrono::seconds(20), {}}) != network::Outcome::complete) {
    throw std::runtime_error("not all controllers connected within 20 s");
  }
}

Ours::~Ours() = default;

void Ours::tick() {
  State& state = *state_;
  ++state.observations.tick;
  state.observations.time_ns += 100'000'000;
  state.server.publish(state.observations, state.tag_payloads);
  if (state.server.collect(state.commands, {std::chrono::seconds(20), {}}) !=
      network::Outcome::complete) {
    throw std::runtime_error("a tick took longer than 20 s");
  }
}

Bytes Ours::bytes() const {
  const std::size_t values = state_->setup.robots * joints;
  v1::ServerMessage down;
  down.mutable_observation()->set_tick(1000);
  down.mutable_observation()->set_time_ns(100'000'000'000);
  v1::ClientMessage up;
  up.mutable_command()->set_tick(1000);
  for (std::size_t i = 0; i < values; ++i) {
    down.mutable_observation()->add_joint_readings(0.5);
    up.mutable_command()->add_joint_targets(1.5);
  }
  return {down.ByteSizeLong(), up.ByteSizeLong()};
}

}  // namespace ziggurat::bench
