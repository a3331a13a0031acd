// SPDX-License-Identifier: MIT
#pragma once
// The protocol's messages as plain data, for modules that do not know protobuf. docs/protocol.md
// defines their meaning, protocol/ziggurat/v1/protocol.proto their form.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/deadline.h"
#include "scene/scene.h"
#include "world/commands.h"
#include "world/layout.h"

namespace ziggurat::wire {

/// The two forms of a message on the wire. A session has one of them from its first byte to its
/// end.
enum class Encoding {
  binary,  ///< protobuf
  json,    ///< protobuf's canonical JSON
};

/// The form of a client's message: JSON begins with `{`, which no binary message of ours does.
inline Encoding encoding_of(std::string_view bytes) {
  return bytes.starts_with('{') ? Encoding::json : Encoding::binary;
}

struct Version {
  std::uint32_t major = 0;
  std::uint32_t minor = 0;
  bool operator==(const Version&) const = default;
};

/// Version of the server. A client must have the same major version.
inline constexpr Version version{1, 5};
/// From this minor version on a session is told of dropped and spawned robots, and what was
/// commanded before it was resumed.
inline constexpr std::uint32_t minor_with_events = 1;
/// From this minor version on ticks have an epoch, and a session may be told that the world went
/// back.
inline constexpr std::uint32_t minor_with_epochs = 2;
/// From this minor version on there are metrics.
inline constexpr std::uint32_t minor_with_metrics = 3;
/// From this minor version on there are directors.
inline constexpr std::uint32_t minor_with_directors = 4;

enum class Role { unspecified, controller, supervisor, observer, director };

/// Parts of the world that a director is sent at each tick.
struct Subscription {
  bool poses = false, links = false, joints = false, leds = false, tags = false, magnets = false,
       radio_messages = false, contacts = false;
  std::vector<std::string> entities;  ///< ids or globs; empty: all
};

using scene::DeadlineAction;
using scene::DeadlinePolicy;

struct Hello {
  Version version;
  Role role = Role::unspecified;
  std::vector<std::string> robots;  ///< ids or globs
  std::string controller;           ///< id in the scene; empty: any
  bool lua_only = false;
  std::string client_name;
  std::string client_version;
  std::string session_token;  ///< of a session to resume; empty: a new one
  /// A wish. The action may be a number that is none; unspecified is read as wait.
  std::optional<DeadlinePolicy> deadline;
  bool takeover = false;                     ///< take robots from other sessions too
  bool can_restore = false;                  ///< its controllers can go back to a snapshot
  std::string director;                      ///< of that role: its id
  std::optional<Subscription> subscription;  ///< likewise; none: it is told of no entity
};

/// A line that a controller logged.
struct LogLine {
  std::size_t robot = 0;  ///< into Layout::robots
  bool error = false;     ///< logerr()
  std::string text;       ///< UTF-8 without a line feed at the end
};

/// A figure of the run that a controller has set.
struct Metric {
  std::size_t robot = 0;  ///< into Layout::robots
  std::string name;       ///< 1 to 64 letters, digits, `_`, `-`, `.`
  double value = 0;       ///< finite
};

enum class LeaveReason { unspecified, done, failed };

struct Leave {
  std::vector<std::uint32_t> robots;  ///< positions in the session; empty: the whole session
  LeaveReason reason = LeaveReason::unspecified;
  std::string message;
};

/// Same names and numbers as Error.Code of the protocol.
enum class ErrorCode {
  unspecified,
  malformed,
  too_large,
  out_of_state,
  version_mismatch,
  stale_tick,
  future_tick,
  duplicate_tick,
  unknown_robot,
  unknown_controller,
  unknown_device,
  bad_value,
  not_yours,
  robot_taken,
  unimplemented,
  forbidden,
  too_many,
  no_such_session,
  deadline_missed,
  unknown_entity,
  robots_dropped,
};

enum class Severity {
  unspecified,
  warning,  ///< the message was taken, in part or whole
  discard,  ///< the message had no effect; the session goes on
  fatal,    ///< the session is over
};

/// An error in a peer's message.
struct Fault {
  ErrorCode code = ErrorCode::unspecified;
  Severity severity = Severity::discard;
  bool retryable = false;
  std::uint64_t tick = 0;
  std::string robot;                        ///< id, where one is concerned
  std::string field;                        ///< where one is concerned
  std::string message;                      ///< a sentence for people
  std::vector<std::uint32_t> dropped = {};  ///< robots_dropped: positions in the session
};

struct Refusal {
  Fault fault;
  Version client_version;
  std::string holder;  ///< robot_taken: name of the client that has it
};

/// Description of a session in its Welcome.
struct Welcome {
  std::string_view token;
  std::uint32_t minor = 0;  ///< of the protocol, as agreed
  Role role = Role::controller;
  std::uint32_t wall_lease_ms = 0;
  std::uint32_t wall_heartbeat_ms = 0;
  std::uint64_t max_message_bytes = std::uint64_t{64} << 20;  ///< of the client's messages
  std::vector<DeadlinePolicy> deadlines = {};  ///< per robot of the session; empty: all wait
  bool is_resumed = false;                     ///< and its client is told of the present state
  const world::Commands* commands =
      nullptr;  ///< resumed: of all robots; null: nothing was commanded
  const scene::Director* director = nullptr;  ///< of that role: which; its script is a path
};

/// A robot that came while the world runs.
struct Spawned {
  std::string_view robot;       ///< id
  std::string_view controller;  ///< id in the scene
  std::uint64_t tick = 0;       ///< from which on it stands there
};

/// The world went back to its start, or to a snapshot.
struct Restart {
  std::uint64_t seed = 1;
  std::optional<std::uint64_t> epoch = {};  ///< that begins; none: the session knows of no epochs
  struct Snapshot {
    std::string_view name;
    std::uint64_t tick = 0;
    const world::Commands* commands = nullptr;  ///< of all robots, as they were then
    std::size_t robots = 0;  ///< so many of the first are the same as before; the others are new
  };
  std::optional<Snapshot> snapshot = {};  ///< none: to the start
};

enum class EndReason { finished, interrupted, failed };

struct End {
  EndReason reason = EndReason::finished;
  std::string message;
  std::uint64_t tick = 0;  ///< the last one
};

/// Description of the run in every Welcome.
struct Run {
  const world::Layout& layout;
  const std::vector<scene::Controller>& controllers;  ///< of the scene
  std::vector<std::string> scripts;  ///< per robot of the layout: resolved path of its Lua
                                     ///< script, or empty
  std::uint64_t seed = 1;
  std::int64_t tick_ns = 0;  ///< simulated time of a tick
  std::uint32_t ticks_per_second = 10;
  std::string scene_hash;  ///< 16 hexadecimal digits
  std::string server_version;
  bool is_hardware_in_the_loop = false;         ///< paced by the clock; no session is waited for
  std::vector<scene::Director> directors = {};  ///< of the scene; their scripts are resolved paths
};

/// The name in docs/protocol.md, for example "ROBOT_TAKEN".
const char* to_string(ErrorCode code);

/// A fault that discards the message and leaves the session as it is.
inline Fault make_fault(ErrorCode code, std::string field, std::string message,
                        std::string robot = {}) {
  Fault fault;
  fault.code = code;
  fault.robot = std::move(robot);
  fault.field = std::move(field);
  fault.message = std::move(message);
  return fault;
}

}  // namespace ziggurat::wire
