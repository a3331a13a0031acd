// SPDX-License-Identifier: MIT
#include "wire/outbox.h"

#include <algorithm>
#include <cstring>

#include "wire/devices.h"
#include "wire/observation.h"
#include "wire/response.h"
#include "ziggurat/v1/envelope.h"
#include "ziggurat/v1/json.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {
namespace {

void fill(const Fault& fault, v1::Error& error) {
  error.set_code(static_cast<v1::Error::Code>(fault.code));
  error.set_severity(static_cast<v1::Error::Severity>(fault.severity));
  error.set_retryable(fault.retryable);
  error.set_tick(fault.tick);
  error.set_robot(v1::valid_utf8(fault.robot));
  error.set_field(fault.field);
  error.set_message(v1::valid_utf8(fault.message));
  if (fault.dropped.empty()) return;
  error.mutable_dropped()->mutable_robots()->Add(fault.dropped.begin(), fault.dropped.end());
}

void fill(const Version& from, v1::Version& to) {
  to.set_major(from.major);
  to.set_minor(from.minor);
}

void fill(const DeadlinePolicy& from, v1::DeadlinePolicy& to) {
  to.set_action(static_cast<v1::DeadlinePolicy::Action>(from.action));
  to.set_wall_deadline_ms(from.wall_deadline_ms);
  to.set_miss_budget(from.miss_budget);
}

/// One policy for all robots, or each its own.
void fill(const std::vector<DeadlinePolicy>& policies, v1::Welcome& welcome) {
  const DeadlinePolicy common = policies.empty() ? DeadlinePolicy{} : policies.front();
  if (std::ranges::all_of(policies, [&](const auto& policy) { return policy == common; })) {
    return fill(common, *welcome.mutable_deadline_policy());
  }
  for (std::size_t i = 0; i < policies.size(); ++i) {
    fill(policies[i], *welcome.mutable_robots(static_cast<int>(i))->mutable_deadline_policy());
  }
}

constexpr std::size_t longest_commanded = std::size_t{1} << 20;  // [bytes]

/// Writes the last commands.
/// @return  false if they are too long for a message
bool fill(const Roster& roster, const world::Commands& commands, v1::Command& command) {
  if (payload_bytes(roster, commands) > longest_commanded) return false;
  add_channels(roster, commands, command);
  return command.ByteSizeLong() <= longest_commanded;
}

/// The present state of a session that is resumed.
void fill(const Roster& roster, const world::Commands* commands, v1::Resumed& resumed) {
  for (std::size_t position = 0; position < roster.gone.size(); ++position) {
    if (roster.gone[position]) resumed.add_gone_robots(static_cast<std::uint32_t>(position));
  }
  if (commands == nullptr) return;
  if (!fill(roster, *commands, *resumed.mutable_commanded())) resumed.clear_commanded();
}

void fill(const scene::Director& from, v1::DirectorDescription& to) {
  to.set_id(v1::valid_utf8(from.id));
  for (const auto& [name, value] : from.params) {
    v1::Parameter& parameter = *to.add_params();
    parameter.set_name(v1::valid_utf8(name));
    parameter.set_value(v1::valid_utf8(value));
  }
  to.set_script(v1::valid_utf8(from.script));
}

v1::End::Reason reason_of(EndReason reason) {
  switch (reason) {
    case EndReason::finished:
      return v1::End::FINISHED;
    case EndReason::interrupted:
      return v1::End::INTERRUPTED;
    case EndReason::failed:
      return v1::End::FAILED;
  }
  return v1::End::REASON_UNSPECIFIED;
}

}  // namespace

struct Outbox::Message {
  v1::ServerMessage message;
  std::size_t size = 0;
  std::string text;          // its JSON, or what is sent of an answer; empty otherwise
  Answer* answer = nullptr;  // the message is made from this one

  // Memory that protobuf keeps for reuse is as large as the largest of each part ever was: now and
  // then it begins anew.
  std::size_t filled = 0;  // [bytes] of parts whose size changes, since it last did
  void forget(std::size_t changing) {
    constexpr std::size_t enough = std::size_t{64} << 20;
    filled += changing;
    if (filled < enough) return;
    filled = changing;
    v1::ServerMessage().Swap(&message);
  }
};

Outbox::Outbox() : message_(std::make_unique<Message>()) {}
Outbox::~Outbox() = default;
Outbox::Outbox(Outbox&&) noexcept = default;
Outbox& Outbox::operator=(Outbox&&) noexcept = default;

void Outbox::finish() {
  message_->answer = nullptr;
  message_->size = message_->message.ByteSizeLong();
  message_->text.clear();
}

void Outbox::encode(Encoding encoding) {
  if (message_->answer != nullptr) {
    message_->text = message_->answer->bytes(message_->message.response().id(), encoding);
    return;
  }
  if (encoding == Encoding::binary) {
    message_->text.clear();
  } else if (message_->text.empty()) {
    message_->text = v1::to_json(message_->message);
  }
}

const v1::ServerMessage& Outbox::message() const { return message_->message; }

bool Outbox::is_observation() const {
  return message_->message.has_observation() || message_->message.has_world_state();
}

std::size_t Outbox::size() const {
  return message_->text.empty() ? message_->size : message_->text.size();
}

void Outbox::write(std::uint8_t* to) const {
  if (!message_->text.empty()) {
    std::memcpy(to, message_->text.data(), message_->text.size());
    return;
  }
  message_->message.SerializeWithCachedSizesToArray(to);
}

void Outbox::welcome(const Run& run, const Roster& roster, const Welcome& session) {
  v1::Welcome& welcome = *message_->message.mutable_welcome();
  welcome.Clear();
  fill(Version{version.major, session.minor}, *welcome.mutable_version());
  welcome.set_session_token(session.token.data(), session.token.size());
  welcome.set_wall_lease_ms(session.wall_lease_ms);
  welcome.set_wall_heartbeat_ms(session.wall_heartbeat_ms);
  welcome.set_role(static_cast<v1::Role>(session.role));
  welcome.set_tick_ns(static_cast<std::uint64_t>(run.tick_ns));
  welcome.set_ticks_per_second(run.ticks_per_second);
  welcome.set_mode(run.is_hardware_in_the_loop ? v1::MODE_HARDWARE_IN_THE_LOOP
                                               : v1::MODE_LOCK_STEP);
  welcome.set_seed(run.seed);
  welcome.set_scene_hash(run.scene_hash);
  welcome.set_max_message_bytes(session.max_message_bytes);
  welcome.set_server_version(run.server_version);
  for (const std::size_t robot : roster.robots) describe(run, robot, *welcome.add_robots());
  fill(session.deadlines, welcome);
  if (session.director) fill(*session.director, *welcome.mutable_director());
  if (session.is_resumed) fill(roster, session.commands, *welcome.mutable_resumed());
  finish();
}

void Outbox::refusal(const Refusal& from) {
  v1::Refusal& refusal = *message_->message.mutable_refusal();
  refusal.Clear();
  fill(from.fault, *refusal.mutable_error());
  fill(version, *refusal.mutable_server_version());
  fill(from.client_version, *refusal.mutable_client_version());
  refusal.set_holder(v1::valid_utf8(from.holder));
  finish();
}

bool Outbox::observation(const Roster& roster, const world::Observations& observations,
                         std::span<const std::string> tag_payloads, std::size_t limit,
                         std::optional<std::uint64_t> epoch) {
  const ReadingSize needed = size_of_readings(roster, observations, tag_payloads);
  if (needed.size > limit) return false;
  message_->forget(needed.payloads);
  v1::Observation& observation = *message_->message.mutable_observation();
  observation.Clear();
  fill(roster, observations, tag_payloads, observation);
  if (epoch) observation.set_epoch(*epoch);
  finish();
  return message_->size <= limit;
}

bool world_layout(Outbox& outbox, const Run& run, const Truth& truth, WorldView& view,
                  std::size_t limit) {
  v1::WorldLayout& layout = *outbox.message_->message.mutable_world_layout();
  layout.Clear();
  const bool is_short = fill(view, truth, run.controllers, limit, layout);
  outbox.finish();
  const std::size_t size = outbox.message_->size;
  const bool fits = is_short && size <= limit;
  if (!fits) layout.Clear();
  outbox.message_->forget(size);
  return fits;
}

bool world_state(Outbox& outbox, const Truth& truth, const WorldView& view, std::size_t limit,
                 std::uint64_t epoch) {
  const ReadingSize needed = size_of_readings(view, truth);
  if (needed.size > limit) return false;
  outbox.message_->forget(needed.payloads);
  v1::WorldState& state = *outbox.message_->message.mutable_world_state();
  state.Clear();
  fill(view, truth, state);
  state.set_epoch(epoch);
  outbox.finish();
  return outbox.message_->size <= limit;
}

void Outbox::end(const End& from) {
  v1::End& end = *message_->message.mutable_end();
  end.Clear();
  end.set_reason(reason_of(from.reason));
  end.set_message(v1::valid_utf8(from.message));
  end.set_tick(from.tick);
  finish();
}

void Outbox::error(const Fault& fault) {
  v1::Error& error = *message_->message.mutable_error();
  error.Clear();
  fill(fault, error);
  finish();
}

void Outbox::loading(double progress, std::string_view text) {
  v1::Loading& loading = *message_->message.mutable_loading();
  loading.set_progress(progress);
  loading.set_message(v1::valid_utf8(text));
  finish();
}

void Outbox::paused(std::uint64_t tick) {
  message_->message.mutable_paused()->set_tick(tick);
  finish();
}

void Outbox::displaced(std::string_view by, std::string_view text) {
  v1::Displaced& displaced = *message_->message.mutable_displaced();
  displaced.set_by(v1::valid_utf8(by));
  displaced.set_message(v1::valid_utf8(text));
  finish();
}

void Outbox::spawned(const Spawned& from) {
  v1::RobotSpawned& spawned = *message_->message.mutable_robot_spawned();
  spawned.set_robot(v1::valid_utf8(from.robot));
  spawned.set_controller(v1::valid_utf8(from.controller));
  spawned.set_tick(from.tick);
  finish();
}

void Outbox::restart(const Roster& roster, const Restart& from) {
  if (from.snapshot) {
    v1::Restored& restored = *message_->message.mutable_restored();
    restored.Clear();
    restored.set_tick(from.snapshot->tick);
    restored.set_snapshot(v1::valid_utf8(from.snapshot->name));
    if (from.epoch) restored.set_epoch(*from.epoch);
    const bool fits = fill(roster, *from.snapshot->commands, *restored.mutable_commanded());
    if (!fits) restored.clear_commanded();
  } else {
    v1::Reset& reset = *message_->message.mutable_reset();
    reset.Clear();
    reset.set_seed(from.seed);
    if (from.epoch) reset.set_epoch(*from.epoch);
  }
  finish();
}

void Outbox::response(std::uint64_t request, std::uint64_t tick,
                      const std::optional<std::string>& overlapped) {
  v1::Response& response = *message_->message.mutable_response();
  response.Clear();
  response.set_id(request);
  response.set_tick(tick);
  if (overlapped) response.mutable_place()->set_overlapped(v1::valid_utf8(*overlapped));
  finish();
}

void Outbox::response(std::uint64_t request, const Status& status) {
  v1::Response& response = *message_->message.mutable_response();
  response.Clear();
  response.set_id(request);
  response.set_tick(status.tick);
  fill(status, *response.mutable_status());
  finish();
}

void Outbox::response(std::uint64_t request, const world::Layout& layout, const world::State& state,
                      std::span<const std::size_t> entities, std::string_view hash) {
  v1::Response& response = *message_->message.mutable_response();
  response.Clear();
  response.set_id(request);
  response.set_tick(state.tick);
  fill(layout, state, entities, *response.mutable_states());
  response.mutable_states()->set_hash(std::string(hash));
  finish();
}

void Outbox::response(std::uint64_t request, Answer& answer) {
  v1::Response& response = *message_->message.mutable_response();
  response.Clear();
  response.set_id(request);
  finish();
  message_->answer = &answer;
}

void Outbox::response(std::uint64_t request, const Fault& fault) {
  v1::Response& response = *message_->message.mutable_response();
  response.Clear();
  response.set_id(request);
  response.set_tick(fault.tick);
  fill(fault, *response.mutable_error());
  finish();
}

void Outbox::heartbeat(std::uint64_t sequence) {
  message_->message.mutable_heartbeat()->set_sequence(sequence);
  finish();
}

}  // namespace ziggurat::wire
