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

/// What happens when the session has not answered an observation after so much wall time.
struct Deadline {
  enum class Action {
    wait = 1,  ///< the world waits for ever
    hold,      ///< what was commanded before stays
    zero,      ///< the robots' commands become zero until they are commanded anew
    drop,      ///< the robots leave the run for good
    stop,      ///< the run ends
  };
  Action action = Action::wait;
  std::chrono::milliseconds after{0};  ///< wall time from observation to answer; > 0 unless wait
  std::uint32_t miss_budget = 0;       ///< misses in a row that are held; of hold and zero: 0 = any
};

/// Whom to connect to and which robots to drive.
struct Options {
  std::string endpoint;  ///< `ipc://…` or `tcp://host:port`

  // Keys, for a server that protects its endpoint (--curve-secret). Both or none.
  std::string server_key;    ///< the server's public key, Z85: 40 characters
  std::string curve_secret;  ///< path of a file with our own secret key, Z85

  // Which robots. Those that fit everything that is given here; all of the scene if nothing is.
  std::string controller;           ///< robots of this controller of the scene
  std::vector<std::string> robots;  ///< ids or globs (`*`, `?`, `[a-z]`)
  bool lua_only = false;            ///< only robots whose controller is a Lua script

  /// Session::token() of a session whose connection is gone: takes that up, with its robots and at
  /// the tick that the world is at. Which robots are asked for is not looked at then; the server
  /// keeps what was commanded, but this side begins with 0: command all values anew.
  std::string session_token;
  bool takeover = false;             ///< also robots that others drive; those sessions are told
  std::optional<Deadline> deadline;  ///< a wish; none: as the scene or the server's owner says

  std::string name = "controller";  ///< of this program, for the server's messages
  std::string version;              ///< of this program, for the server's messages

  std::chrono::milliseconds connect_timeout{10'000};  ///< wall time until the server's welcome
  /// Wall time that next() waits for the world; none = for ever: others may take their time.
  std::optional<std::chrono::milliseconds> wait_timeout;
  /// Asked while waiting, after each signal and at least every half second of wall time: true ends
  /// the wait. next() then returns false without an ending, and the session can still leave; the
  /// constructor throws ConnectionError. None = nothing interrupts.
  std::function<bool()> is_interrupted;

  /// Endpoint from ZIGGURAT_ENDPOINT, controller from ZIGGURAT_CONTROLLER if that is set: how
  /// `ziggurat run` starts controllers. Keys from ZIGGURAT_SERVER_KEY and ZIGGURAT_CURVE_SECRET.
  /// @throws std::invalid_argument without ZIGGURAT_ENDPOINT
  static Options from_environment();
};

/// What is due now.
enum class Event {
  init,   ///< the first observation; with readings 0 at tick 0, the world before any physics
  step,   ///< a tick passed
  reset,  ///< the world went back to tick 0
};

/// Why there are no more ticks.
struct Ending {
  enum class Reason {
    finished,     ///< the length of the scene was reached
    interrupted,  ///< somebody stopped the server
    failed,       ///< the run can't go on; `message` says why
  };
  Reason reason = Reason::finished;
  std::string message;
  std::uint64_t tick = 0;  ///< the last one
};

/// Drives one or more robots in lock-step: the world waits for the answer of every session.
/// Leaves the world when destroyed: as failed if that happens by an exception, else as done.
/// Not thread-safe.
class Session {
 public:
  /// Connects and waits for the server's welcome.
  /// @throws ConnectionError, ProtocolError, std::invalid_argument for an unusable endpoint
  explicit Session(const Options& options);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Answers the observation in hand with what was set since, and waits for the next. False once
  /// there are no more ticks; the first call delivers Event::init.
  /// @throws ConnectionError; after mere silence, calling again goes on waiting
  /// @throws ProtocolError
  bool next();

  Event event() const noexcept;                    ///< that next() delivered
  std::uint64_t tick() const noexcept;             ///< of the observation in hand
  std::chrono::nanoseconds time() const noexcept;  ///< simulated, of the observation in hand
  /// Why next() returned false; none before that.
  const std::optional<Ending>& ending() const noexcept;

  const std::string& token() const noexcept;  ///< for Options::session_token; any bytes
  std::uint64_t missed() const noexcept;      ///< ticks that went on without our answer

  std::span<Robot> robots() noexcept;  ///< in scene order
  /// @throws std::out_of_range, naming the robots there are
  Robot& robot(std::string_view id);

  std::chrono::nanoseconds tick_length() const noexcept;  ///< simulated
  std::uint32_t ticks_per_second() const noexcept;
  std::uint64_t seed() const noexcept;             ///< of the run; after a reset, the new one
  const std::string& scene_hash() const noexcept;  ///< 16 hexadecimal digits
  const std::string& server_version() const noexcept;

  /// Leaves the world now: sends what is still to be logged and says that the controller is done
  /// or, with a message, that it failed. What the destructor does otherwise. No effect if called
  /// again.
  void leave();
  void leave_failed(std::string_view message);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ziggurat
