// SPDX-License-Identifier: MIT
#pragma once
// Messages of a server to a director: a world with an arm and a box.

#include <chrono>
#include <cstdint>

#include "clients/fake_server.h"
#include "ziggurat/director.h"

namespace ziggurat {

inline v1::ServerMessage judge() {
  v1::ServerMessage message;
  v1::Welcome& welcome = *message.mutable_welcome();
  welcome.mutable_version()->set_major(1);
  welcome.set_seed(7);
  welcome.set_tick_ns(50'000'000);
  welcome.set_session_token("token");
  welcome.mutable_director()->set_id("judge");
  welcome.mutable_director()->set_script("/judge.lua");
  v1::Parameter& param = *welcome.mutable_director()->add_params();
  param.set_name("goal");
  param.set_value("3");
  return message;
}

/// An arm of two links with a joint, two LEDs and a radio; a box of one link.
inline v1::ServerMessage arm_and_box() {
  v1::ServerMessage message;
  v1::WorldLayout& layout = *message.mutable_world_layout();
  v1::EntityDescription& arm = *layout.add_entities();
  arm.set_id("arm");
  arm.set_kind("prototype");
  arm.set_controller("swing");
  arm.add_links("base");
  arm.add_links("tip");
  arm.add_joints("hinge");
  arm.add_leds();
  arm.add_leds();
  arm.add_radios()->set_id("tx");
  v1::EntityDescription& box = *layout.add_entities();
  box.set_id("box");
  box.set_kind("box");
  box.add_links("");
  return message;
}

/// Number i of each array is i, and its tick.
inline v1::ServerMessage state(std::uint64_t tick, int entities) {
  v1::ServerMessage message;
  v1::WorldState& state = *message.mutable_world_state();
  state.set_tick(tick);
  state.set_time_ns(static_cast<std::int64_t>(tick) * 50'000'000);
  for (int i = 0; i < 7 * entities; ++i) state.add_poses(i + 100.0 * static_cast<double>(tick));
  return message;
}

/// All groups of such a tick: each number is its place in its array.
/// @param sender  of the radio message
inline v1::ServerMessage full_state(std::uint64_t tick, int sender) {
  auto message = state(tick, 2);
  v1::WorldState& all = *message.mutable_world_state();
  for (int i = 0; i < 13 * 3; ++i) all.add_links(i);
  all.add_joints(0.5);
  all.add_joints(-2);
  all.add_led_colors(0xff0000);
  all.add_led_colors(0x0000ff);
  for (const int link : {1, 2, 2, -1}) all.add_contact_links(link);
  for (int i = 0; i < 18; ++i) all.add_contacts(i);
  v1::ReceivedMessage& radio = *all.add_radio_messages();
  radio.set_sender(sender);
  radio.set_payload("hi");
  return message;
}

inline DirectorOptions options_of(const FakeServer& server) {
  DirectorOptions options;
  options.endpoint = server.endpoint;
  options.director = "judge";
  options.wait_timeout = std::chrono::milliseconds{20'000};
  return options;
}

}  // namespace ziggurat
