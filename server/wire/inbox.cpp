// SPDX-License-Identifier: MIT
#include "wire/inbox.h"

#include <google/protobuf/arena.h>
#include <google/protobuf/stubs/logging.h>

#include <algorithm>
#include <limits>
#include <new>

#include "wire/command.h"
#include "wire/messages.h"
#include "wire/read_json.h"
#include "wire/response.h"
#include "ziggurat/v1/envelope.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {

namespace {

Subscription read(const v1::Subscription& from) {
  using Wanted = v1::Subscription;
  Subscription to;
  to.entities.assign(from.entities().begin(), from.entities().end());
  const auto wants = [&](Wanted::Group group) {
    return std::ranges::find(from.groups(), static_cast<int>(group)) != from.groups().end();
  };
  to.poses = wants(Wanted::POSES);
  to.links = wants(Wanted::LINKS);
  to.joints = wants(Wanted::JOINTS);
  to.leds = wants(Wanted::LEDS);
  to.tags = wants(Wanted::TAGS);
  to.magnets = wants(Wanted::MAGNETS);
  to.radio_messages = wants(Wanted::RADIO_MESSAGES);
  to.contacts = wants(Wanted::CONTACTS);
  return to;
}

}  // namespace

struct Inbox::Message {
  /// A message in an arena, which is never destroyed if decoding runs out of memory. Otherwise
  /// protobuf would read parts that it marked as present before it had made them, and leak others.
  template <class Content>
  class InArena {
   public:
    const Content& content() const {
      return content_ == nullptr ? Content::default_instance() : *content_;
    }
    /// Content, which keeps its memory for reuse. @throws std::bad_alloc
    Content& made() {
      if (content_ == nullptr) content_ = google::protobuf::Arena::CreateMessage<Content>(&arena_);
      return *content_;
    }
    void drop() {
      content_ = nullptr;
      arena_.Reset();
    }

   private:
    google::protobuf::Arena arena_;
    Content* content_ = nullptr;
  };

  Kind kind = Kind::malformed;
  InArena<v1::Command> long_lived;  // the tick path
  InArena<v1::ClientMessage> other;
  const v1::Command* command = nullptr;  // of that kind: in one of the two
  std::string complaint;

  const google::protobuf::RepeatedPtrField<v1::Metric>& metrics() const {
    return kind == Kind::command ? command->metrics() : other.content().leave().metrics();
  }

  // Memory that protobuf keeps for reuse is as large as the largest of each part ever was. Peers
  // decide on that, so now and then both messages begin anew.
  std::size_t parsed = 0;  // [bytes] since they last did
  void forget(std::size_t size) {
    constexpr std::size_t enough = std::size_t{64} << 20;
    parsed += size;
    if (parsed < enough) return;
    forget();
    parsed = size;
  }
  void forget() {
    parsed = 0;
    long_lived.drop();
    other.drop();
  }
};

constexpr const char* neither = "it is neither protobuf nor JSON, which begins with '{'";

Inbox::Inbox() : message_(std::make_unique<Message>()) {
  // protobuf would print a line for text that is no UTF-8: a peer's to send, and ours to answer.
  google::protobuf::SetLogHandler(nullptr);
}
Inbox::~Inbox() = default;

Inbox::Kind Inbox::parse(std::string_view bytes, std::size_t most) {
  Message& in = *message_;
  in.kind = Kind::malformed;
  in.complaint.clear();
  if (bytes.size() > std::numeric_limits<int>::max()) return in.kind;
  try {
    const bool is_json = encoding_of(bytes) == Encoding::json;
    const std::size_t fields = is_json ? count_json_values(bytes) : count_fields(bytes);
    if (fields > most_fields) {
      in.complaint = "it has more fields than any message needs";
      return in.kind;
    }
    if (fields > most) return in.kind = Kind::too_large;
    in.forget(bytes.size());
    return decode(bytes);
  } catch (const std::bad_alloc&) {
    in.forget();
    in.complaint = "there is no memory for it";
    return in.kind = Kind::malformed;
  }
}

Inbox::Kind Inbox::decode(std::string_view bytes) {
  Message& in = *message_;
  if (const auto content = v1::sole_field(bytes, v1::ClientMessage::kCommandFieldNumber)) {
    v1::Command& command = in.long_lived.made();
    if (!command.ParseFromArray(content->data(), static_cast<int>(content->size()))) {
      in.complaint = neither;
      return in.kind;
    }
    in.command = &command;
    return in.kind = Kind::command;
  }
  in.other.drop();
  v1::ClientMessage& message = in.other.made();
  if (encoding_of(bytes) == Encoding::json) {
    in.complaint = read_json(bytes, message);
    if (!in.complaint.empty()) return in.kind;
  } else if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
    in.complaint = neither;
    return in.kind;
  }
  switch (message.message_case()) {
    case v1::ClientMessage::kHello:
      in.kind = Kind::hello;
      break;
    case v1::ClientMessage::kLeave:
      in.kind = Kind::leave;
      break;
    case v1::ClientMessage::kHeartbeat:
      in.kind = Kind::heartbeat;
      break;
    case v1::ClientMessage::kRequest:
      in.kind = Kind::request;
      break;
    case v1::ClientMessage::kCommand:
      in.kind = Kind::command;
      in.command = &message.command();
      break;
    case v1::ClientMessage::kDirection:
      in.kind = Kind::direction;
      break;
    case v1::ClientMessage::MESSAGE_NOT_SET:
      in.complaint = "it has none of the messages that clients send";
      break;
  }
  return in.kind;
}

const std::string& Inbox::complaint() const { return message_->complaint; }

Hello Inbox::hello() const {
  const v1::Hello& from = message_->other.content().hello();
  Hello hello;
  hello.version = {from.version().major(), from.version().minor()};
  hello.role = static_cast<Role>(from.role());
  hello.robots.assign(from.robots().begin(), from.robots().end());
  hello.controller = from.controller();
  hello.lua_only = from.lua_only();
  hello.client_name = from.client_name();
  hello.client_version = from.client_version();
  hello.session_token = from.session_token();
  if (from.has_deadline_policy()) {
    const v1::DeadlinePolicy& wish = from.deadline_policy();
    DeadlinePolicy& deadline = hello.deadline.emplace();
    if (wish.action() != v1::DeadlinePolicy::ACTION_UNSPECIFIED) {
      deadline.action = static_cast<DeadlineAction>(wish.action());
    }
    deadline.wall_deadline_ms = wish.wall_deadline_ms();
    deadline.miss_budget = wish.miss_budget();
  }
  hello.takeover = from.takeover();
  hello.can_restore = from.can_restore();
  hello.director = from.director();
  if (from.has_subscription()) hello.subscription = read(from.subscription());
  return hello;
}

Leave Inbox::leave() const {
  const v1::Leave& from = message_->other.content().leave();
  Leave leave;
  leave.robots.assign(from.robots().begin(), from.robots().end());
  leave.reason = static_cast<LeaveReason>(from.reason());
  leave.message = from.message();
  return leave;
}

std::uint64_t Inbox::heartbeat() const { return message_->other.content().heartbeat().sequence(); }

std::uint64_t Inbox::request_id() const { return message_->other.content().request().id(); }

Request Inbox::request() const { return read(message_->other.content().request()); }

bool Inbox::is_question() const {
  const auto request = message_->other.content().request().request_case();
  return message_->kind == Kind::request &&
         (request == v1::Request::kStatus || request == v1::Request::kRead);
}

bool Inbox::is_answer() const {
  return message_->kind == Kind::command || message_->kind == Kind::direction;
}

std::uint64_t Inbox::command_tick() const {
  return message_->kind == Kind::command ? message_->command->tick()
                                         : message_->other.content().direction().tick();
}

std::optional<std::uint64_t> Inbox::command_epoch() const {
  const auto epoch_of = [](const auto& answer) {
    return answer.has_epoch() ? std::optional(answer.epoch()) : std::nullopt;
  };
  return message_->kind == Kind::command ? epoch_of(*message_->command)
                                         : epoch_of(message_->other.content().direction());
}

std::optional<Fault> Inbox::check_direction() const {
  if (message_->kind == Kind::direction) {
    return wire::check(message_->other.content().direction());
  }
  const v1::Leave& leave = message_->other.content().leave();
  if (leave.reason() != v1::Leave::DONE && leave.reason() != v1::Leave::FAILED) {
    return make_fault(ErrorCode::bad_value, "reason",
                      "The reason of a Leave must be DONE or FAILED.");
  }
  if (!leave.robots().empty()) {
    return make_fault(ErrorCode::unknown_robot, "robots", "A director has no robots.");
  }
  return check_names_and_values(leave.metrics());
}

Direction Inbox::direction() const {
  if (message_->kind == Kind::direction) return read(message_->other.content().direction());
  v1::Direction last;
  *last.mutable_log() = message_->other.content().leave().log();
  *last.mutable_metrics() = message_->other.content().leave().metrics();
  return read(last);
}

std::optional<Fault> Inbox::check(const Roster& roster, const world::Layout& layout) const {
  if (message_->kind == Kind::command) return wire::check(*message_->command, roster, layout);
  return wire::check(message_->other.content().leave(), roster, layout);
}

std::optional<Fault> Inbox::check_metrics(const Roster& roster) const {
  return wire::check(message_->metrics(), roster);
}

std::vector<Metric> Inbox::metrics(const Roster& roster) const {
  std::vector<Metric> metrics;
  append(message_->metrics(), roster, metrics);
  return metrics;
}

void Inbox::apply(const Roster& roster, world::Commands& commands) const {
  wire::apply(*message_->command, roster, commands);
}

void Inbox::append_log(const Roster& roster, std::vector<LogLine>& lines) const {
  const auto& log = message_->kind == Kind::command ? message_->command->log()
                                                    : message_->other.content().leave().log();
  append(log, roster, lines);
}

}  // namespace ziggurat::wire
