// SPDX-License-Identifier: MIT
#pragma once
// Core of the sessions of controllers and directors: Hello and Welcome, ticks and their answers,
// the end, and the way back after a lost connection.

#include <exception>

#include "connection.h"
#include "driven.h"
#include "part.h"
#include "ziggurat/error.h"
#include "ziggurat/session.h"

namespace ziggurat {

struct SessionCore {
  using Clock = std::chrono::steady_clock;

  /// @param part  outlives this
  SessionCore(const SessionOptions& from, Part& of)
      : options(from), connection(from), part(of), driven(from.endpoint) {}
  SessionCore(const SessionCore&) = delete;
  SessionCore& operator=(const SessionCore&) = delete;

  // welcome.cpp
  void open();  // Hello … Welcome
  void read(const v1::Welcome& welcome);
  void send_hello();

  // resume.cpp
  bool resume(const std::string& loss);  // false: interrupted; @throws if that is not possible
  std::chrono::milliseconds patience() const;
  bool hear_welcome(Clock::time_point end);
  void go_on(const v1::Welcome& welcome);
  bool pause(std::chrono::milliseconds length);
  bool repeats_answer(const Moment& next);

  // session_core.cpp
  bool next();  // answers, and waits for the next message to answer
  bool advance();
  void answer();
  void send_answer();
  /// Asks while a tick waits for the answer; the response stays until the next message is received.
  /// @throws ConnectionError, ProtocolError if it is refused, std::logic_error if no tick waits
  const v1::Response& ask(v1::ClientMessage& question);
  bool wait();  // false if there is none
  bool hear(
      Connection::Kind kind);  // a message that is not to be answered; false after the last one
  void read_moment();          // the message to answer
  void take(const Moment& next);
  void take(const v1::Error& error);
  bool is_interrupted() const { return options.is_interrupted && options.is_interrupted(); }
  void read(const v1::End& end);
  void read(const v1::Reset& reset);
  void read_reset();
  void read(const v1::Restored& restored);
  void leave(v1::Leave::Reason reason, std::string_view message);
  void leave_at_the_end() noexcept;  // of its owner: as failed if an exception is the cause

  SessionOptions options;
  Connection connection;
  Part& part;
  Driven driven;
  int exceptions = std::uncaught_exceptions();  // when the session began

  v1::ClientMessage outgoing;       // the last answer; long-lived: keeps its memory
  std::vector<v1::Leave> failures;  // that were sent before it

  Event event = Event::init;
  bool has_begun = false;    // a message to answer was delivered
  bool is_reset = false;     // the next one is the first after a reset
  v1::Command commanded;     // when the session was resumed last
  bool is_restored = false;  // or after a restore
  std::string snapshot;      // that was restored last
  Moment now;                // of the message to answer
  bool was_reset = false;    // at some time
  bool owes = false;         // the present message is not answered yet
  bool is_over = false;      // nothing is sent any more
  std::optional<Ending> ending;
  std::string fault;  // of the last next(), if it was thrown

  std::chrono::nanoseconds tick_length{0};
  std::uint32_t ticks_per_second = 0;
  std::uint64_t seed = 0;
  std::string scene_hash;
  std::string server_version;
  std::string token;
  std::chrono::milliseconds lease{0};
  std::uint64_t missed = 0;
  std::uint64_t resumes = 0;
  unsigned resumes_in_vain = 0;  // without a message that is new
  bool is_resumed = false;       // the next message may be the last one again
  std::uint64_t last_question = 0;
  std::optional<Connection::Kind> heard;  // instead of the answer to a question: the next message
};

/// @throws ConnectionError if the server speaks another major version of the protocol (H2)
void check_welcome(const v1::Welcome& welcome, const std::string& endpoint);
/// @throws ProtocolError if the message is a Refusal or an Error
void check_not_refused(Connection::Kind kind, const v1::ServerMessage& message);

/// The error as an exception.
/// @param holder  of a refusal: the client that owns the robot
ProtocolError to_exception(const v1::Error& error, const std::string& holder = {});

}  // namespace ziggurat
