#pragma once
// The members of a Session.

#include <exception>

#include "connection.h"
#include "fleet.h"
#include "ziggurat/error.h"
#include "ziggurat/session.h"

namespace ziggurat {

struct Session::State {
  using Clock = std::chrono::steady_clock;

  explicit State(const Options& from) : options(from), connection(from) {}

  // welcome.cpp
  void open();  // Hello … Welcome
  void begin(const v1::Welcome& welcome);
  void read(const v1::Welcome& welcome);
  void send_hello();

  // resume.cpp
  bool resume(const std::string& loss);  // false: interrupted; @throws if that is not possible
  std::chrono::milliseconds patience() const;
  bool hear_welcome(Clock::time_point end);
  void go_on(const v1::Welcome& welcome);
  bool pause(std::chrono::milliseconds length);
  bool repeats_answer(const v1::Observation& observation);

  // session.cpp
  void answer();  // with a Command, after the Leaves of robots that failed
  void send_answer();
  bool wait();  // for the next observation; false if there is none
  void take(const v1::Error& error);
  bool is_interrupted() const { return options.is_interrupted && options.is_interrupted(); }
  void read(const v1::Observation& observation);
  void read(const v1::End& end);
  void read(const v1::Reset& reset);
  void read_reset();
  void read(const v1::Restored& restored);
  void read(const v1::RobotSpawned& robot);
  void leave(v1::Leave::Reason reason, std::string_view message);

  Options options;
  Connection connection;
  int exceptions = std::uncaught_exceptions();  // when the session began

  std::optional<Fleet> fleet;  // from Welcome on
  v1::ClientMessage outgoing;  // the last Command; long-lived: keeps its memory
  std::vector<v1::Leave> failures;  // that were sent before it

  Event event = Event::init;
  bool has_begun = false;  // an observation was delivered
  bool is_reset = false;   // the next observation is the first after a reset
  v1::Command commanded;               // when the session was resumed last
  bool is_restored = false;            // or after a restore
  std::string snapshot;                // that was restored last
  std::optional<std::uint64_t> epoch;  // of the current observation
  bool was_reset = false;  // at some time
  bool owes = false;       // the current observation is not answered yet
  bool is_over = false;    // nothing is sent any more
  std::uint64_t tick = 0;
  std::chrono::nanoseconds time{0};
  std::optional<Ending> ending;

  std::chrono::nanoseconds tick_length{0};
  std::uint32_t ticks_per_second = 0;
  std::uint64_t seed = 0;
  std::string scene_hash;
  std::string server_version;
  std::string token;
  std::chrono::milliseconds lease{0};
  std::uint64_t missed = 0;
  std::uint64_t resumes = 0;
  unsigned resumes_in_vain = 0;  // without an observation that is new
  bool is_resumed = false;       // the next observation may be the last one again
  std::vector<SpawnedRobot> spawned;
};

/// @throws ProtocolError if the message is a Refusal or an Error
void check_not_refused(Connection::Kind kind, const v1::ServerMessage& message);

/// The error as an exception.
/// @param holder  of a refusal: the client that owns the robot
ProtocolError to_exception(const v1::Error& error, const std::string& holder = {});

}  // namespace ziggurat
