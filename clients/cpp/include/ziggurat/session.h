// SPDX-License-Identifier: MIT
#pragma once
// A session with the server: connects, waits for ticks, answers them.

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ziggurat/robot.h"

namespace ziggurat {

/// Deadline for the answer to an observation, and the consequence of a miss; wall time.
struct Deadline {
  enum class Action {
    wait = 1,  ///< the world waits forever
    hold,      ///< the last commands stay
    zero,      ///< the robots' commands become zero until the next command
    drop,      ///< the robots leave the run forever
    stop,      ///< the run ends
  };
  Action action = Action::wait;
  std::chrono::milliseconds after{0};  ///< wall time from observation to answer; > 0 unless wait
  /// Misses in a row that hold and zero allow; 0 = any number.
  std::uint32_t miss_budget = 0;
};

/// The server to connect to, and how: of controllers and directors.
struct SessionOptions {
  std::string endpoint;  ///< `ipc://…` or `tcp://host:port`

  // Keys, for a server with an encrypted endpoint (--curve-secret). Both or none.
  std::string server_key;    ///< the server's public key, Z85: 40 characters
  std::string curve_secret;  ///< path of a file with this client's secret key, Z85

  /// token() of an earlier session: resumes it at the present tick. What it asks for otherwise is
  /// ignored then. The values of a controller's last commands stay, and the handles of the new
  /// session begin with them; a server of protocol version 1.0 does not send them, and the handles
  /// begin with the scene's values: set all values again then.
  std::string session_token;
  /// Whether this client can go back: at Event::restored it takes the state that it had at the tick
  /// of the snapshot. Without, the server refuses to restore the world while this session is there.
  bool can_restore = false;
  std::optional<Deadline> deadline;  ///< a wish; none = as the scene or the server's options say

  std::string
      name;  ///< of this program, for the server's messages; empty: the controller, or `director`
  std::string version;  ///< of this program, for the server's messages

  std::chrono::milliseconds connect_timeout{10'000};  ///< wall time until the server's welcome
  /// Wall time for which next() tries to resume the session after a lost connection: it connects
  /// again, says who it is by the session's token, and goes on as if nothing had happened. None =
  /// as long as the server reserves the robots (`ziggurat serve --lease`), at least 10 s; 0 =
  /// never. A server that accepts the connection and is slow to answer is waited for. Over tcp a
  /// connection is lost, too, if the server is silent for three times its heartbeat (3 s).
  std::optional<std::chrono::milliseconds> resume_timeout;
  /// Wall time that next() waits for the next tick; none = forever, as other sessions may be slow.
  std::optional<std::chrono::milliseconds> wait_timeout;
  /// Called while waiting, after each signal and at least every half second of wall time: true ends
  /// the wait. next() then returns false without an ending, and the session can still leave; the
  /// constructor throws ConnectionError. None = no interruption.
  std::function<bool()> is_interrupted;

  /// The endpoint, if there is none yet, is ZIGGURAT_ENDPOINT, otherwise that of find_server().
  /// Keys are ZIGGURAT_SERVER_KEY and ZIGGURAT_CURVE_SECRET; the token is that of
  /// take_session_token(), unless the endpoint is another than ZIGGURAT_ENDPOINT. `ziggurat run`
  /// sets them for the programs that it starts. @throws std::invalid_argument, see find_server()
  /// and take_session_token()
  void read_environment();
};

/// Options of a controller: its robots.
struct Options : SessionOptions {
  // The robots that match all of these; if none is set, all robots of the scene.
  std::string controller;           ///< robots of this controller of the scene
  std::vector<std::string> robots;  ///< ids or globs (`*`, `?`, `[a-z]`)
  bool lua_only = false;            ///< only robots with a Lua script as controller
  bool takeover = false;            ///< also robots of other sessions, which keep the rest

  /// As read_environment(); the controller is ZIGGURAT_CONTROLLER.
  static Options from_environment();
};

/// The endpoint of the only server of this user that `ziggurat serve` has started on this machine
/// without --endpoint. @throws std::invalid_argument if there is none, or more than one
std::string find_server();

/// The token of the session that a program is started to resume: ZIGGURAT_SESSION_TOKEN, two
/// hexadecimal digits for each byte. Removed from the environment, because it is a secret and for
/// one session only. Empty if there is none. @throws std::invalid_argument if it is not hexadecimal
std::string take_session_token();

/// Purpose of an observation.
enum class Event {
  init,      ///< the first of the session; at tick 0, before any physics, readings are 0
  step,      ///< a tick passed
  reset,     ///< the world went back to tick 0
  restored,  ///< the world went back to a snapshot, see Session::snapshot()
};

/// Why the run ended.
struct Ending {
  enum class Reason {
    finished,     ///< the length of the scene was reached
    interrupted,  ///< the server was stopped
    failed,       ///< the run can't continue; `message` is the reason
  };
  Reason reason = Reason::finished;
  std::string message;     ///< printable, 4096 bytes at most
  std::uint64_t tick = 0;  ///< the last one
};

/// A robot that a supervisor spawned. A new session takes it: Options::robots = {id}.
struct SpawnedRobot {
  std::string id;
  std::string controller;  ///< id in the scene
  std::uint64_t tick = 0;  ///< from which on it stands there
};

/// Controls one or more robots in lock-step: the world waits for the answer of every session.
/// Leaves the run when destroyed: as failed if an exception is the cause, otherwise as done. Not
/// thread-safe.
class Session {
 public:
  /// Connects and waits for the server's welcome.
  /// @throws ConnectionError, ProtocolError, std::invalid_argument for an unusable endpoint
  explicit Session(const Options& options);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Answers the current observation with all values that were set, and waits for the next. False
  /// after the last tick. The first call delivers Event::init. If the connection is lost meanwhile,
  /// the session is resumed (Options::resume_timeout): no tick is delivered twice, and an answer
  /// that was lost is sent again.
  /// @throws ConnectionError; after a time-out, another call waits again
  /// @throws ProtocolError, also if the server does not resume the session
  bool next();

  Event event() const noexcept;                    ///< of the current observation
  std::uint64_t tick() const noexcept;             ///< of the current observation
  std::chrono::nanoseconds time() const noexcept;  ///< simulated, of the current observation
  /// Set when next() has returned false at the end of the run.
  const std::optional<Ending>& ending() const noexcept;

  /// The name of the snapshot that the world went back to last; empty: it never did.
  const std::string& snapshot() const noexcept;
  const std::string& token() const noexcept;  ///< for Options::session_token; any bytes
  std::uint64_t missed() const noexcept;      ///< ticks that did not wait for this session's answer
  std::uint64_t resumes() const noexcept;     ///< how often a lost connection was replaced
  /// Robots that were spawned since the last call, of controllers that robots of this session have.
  std::vector<SpawnedRobot> take_spawned();

  std::span<Robot> robots() noexcept;  ///< in scene order
  /// @throws std::out_of_range, listing the ids that exist
  Robot& robot(std::string_view id);

  std::chrono::nanoseconds tick_length() const noexcept;  ///< simulated
  std::uint32_t ticks_per_second() const noexcept;
  std::uint64_t seed() const noexcept;             ///< of the run; after a reset, the new one
  const std::string& scene_hash() const noexcept;  ///< 16 hexadecimal digits
  const std::string& server_version() const noexcept;

  /// Leaves the run now, with the log lines that were not sent yet: as done, or as failed with a
  /// message. Otherwise the destructor does that. A second call has no effect.
  void leave();
  void leave_failed(std::string_view message);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ziggurat
