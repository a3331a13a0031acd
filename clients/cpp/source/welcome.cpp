// SPDX-License-Identifier: MIT
// The start of a session: Hello and Welcome.

#include <algorithm>

#include "endpoint.h"
#include "session_core.h"
#include "ziggurat/v1/envelope.h"

namespace ziggurat {
namespace {

void fill(const SessionOptions& options, v1::Hello& hello) {
  hello.mutable_version()->set_major(version_major);
  hello.mutable_version()->set_minor(version_minor);
  hello.set_client_name(v1::valid_utf8(options.name));
  hello.set_client_version(v1::valid_utf8(options.version));
  hello.set_session_token(options.session_token);
  hello.set_can_restore(options.can_restore);
  if (options.deadline) {
    v1::DeadlinePolicy& policy = *hello.mutable_deadline_policy();
    policy.set_action(static_cast<v1::DeadlinePolicy::Action>(options.deadline->action));
    policy.set_wall_deadline_ms(static_cast<std::uint32_t>(options.deadline->after.count()));
    policy.set_miss_budget(options.deadline->miss_budget);
  }
}

/// Longest silence of a connection that is not lost (docs/protocol.md, M3); 0 = any time.
std::chrono::milliseconds longest_silence(const v1::Welcome& welcome,
                                          const SessionOptions& options) {
  // The end of a local connection is always told, so a server that is silent there is slow.
  if (welcome.wall_heartbeat_ms() == 0 || options.endpoint.starts_with("ipc://")) return {};
  return std::max(std::chrono::milliseconds(3000),
                  3 * std::chrono::milliseconds(welcome.wall_heartbeat_ms()));
}

}  // namespace

void SessionCore::send_hello() {
  v1::ClientMessage message;
  fill(options, *message.mutable_hello());
  part.ask(*message.mutable_hello());
  connection.send(message);
}

void SessionCore::open() {
  send_hello();
  for (;;) {
    const auto kind = connection.receive(options.connect_timeout, options.is_interrupted);
    if (!kind && is_interrupted()) {
      throw ConnectionError("interrupted while waiting for a welcome at " + options.endpoint);
    }
    if (!kind && has_unknown_host(options.endpoint)) {
      throw ConnectionError(options.endpoint + ": no host of that name is known");
    }
    if (!kind) {
      throw ConnectionError("no welcome from a server at " + options.endpoint + " within " +
                            std::to_string(options.connect_timeout.count()) + " ms");
    }
    if (*kind != Connection::Kind::kWelcome) {
      check_not_refused(*kind, connection.message());
      continue;  // still loading, or a message of a later version
    }
    const v1::Welcome& welcome = connection.message().welcome();
    check_welcome(welcome, options.endpoint);
    read(welcome);
    try {
      part.begin(welcome);
    } catch (const std::runtime_error& error) {
      throw ConnectionError(options.endpoint + ": " + error.what());
    }
    return;
  }
}

void SessionCore::read(const v1::Welcome& welcome) {
  tick_length = std::chrono::nanoseconds(welcome.tick_ns());
  ticks_per_second = welcome.ticks_per_second();
  seed = welcome.seed();
  scene_hash = welcome.scene_hash();
  server_version = welcome.server_version();
  token = welcome.session_token();
  driven.is(welcome.robots_size() > 0 ? welcome.robots(0).id() : welcome.director().id());
  lease = std::chrono::milliseconds(welcome.wall_lease_ms());
  connection.begin_session(longest_silence(welcome, options));
}

void check_welcome(const v1::Welcome& welcome, const std::string& endpoint) {
  const v1::Version& theirs = welcome.version();
  if (theirs.major() == version_major) return;
  throw ConnectionError(endpoint + ": the server speaks version " + std::to_string(theirs.major()) +
                        "." + std::to_string(theirs.minor()) + " of the protocol, this client " +
                        std::to_string(version_major) + "." + std::to_string(version_minor));
}

void check_not_refused(Connection::Kind kind, const v1::ServerMessage& message) {
  if (kind == Connection::Kind::kRefusal) {
    throw to_exception(message.refusal().error(), message.refusal().holder());
  }
  if (kind == Connection::Kind::kError) throw to_exception(message.error());
}

ProtocolError to_exception(const v1::Error& error, const std::string& holder) {
  ProtocolError::Details details;
  details.code = v1::Error::Code_Name(error.code());
  if (details.code.empty()) details.code = "CODE_" + std::to_string(error.code());
  details.retryable = error.retryable();
  details.tick = error.tick();
  details.robot = error.robot();
  details.field = error.field();
  details.holder = holder;
  return ProtocolError(details.code + ": " + error.message(), details);
}

}  // namespace ziggurat
