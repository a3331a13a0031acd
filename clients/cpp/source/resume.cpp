// SPDX-License-Identifier: MIT
// A session whose connection was lost goes on over another one.

#include <algorithm>
#include <thread>

#include "session_core.h"

namespace ziggurat {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds usual_patience{10'000};  // as Options::connect_timeout
constexpr milliseconds between_attempts{100};   // while there is no server
constexpr milliseconds between_hellos{1000};    // of a server that answers (docs/protocol.md, H10)
constexpr unsigned most_in_vain = 3;

}  // namespace

milliseconds SessionCore::patience() const {
  return options.resume_timeout.value_or(std::max(lease, usual_patience));
}

bool SessionCore::resume(const std::string& loss) {
  const auto end = Clock::now() + patience();
  heard.reset();
  // The answer itself may be why the server closes the connection.
  if (token.empty() || patience().count() == 0 || ++resumes_in_vain > most_in_vain) {
    is_over = true;
    throw ConnectionError(loss);
  }
  options.session_token = token;
  auto rest = resumes_in_vain > 1 ? between_hellos : milliseconds{0};
  for (;;) {
    if (!pause(rest)) return false;
    try {
      connection.reconnect();
      send_hello();
      return hear_welcome(end);
    } catch (const ConnectionError& error) {
      is_over = Clock::now() >= end;
      if (is_over) {
        throw ConnectionError(loss + "; the session was not resumed within " +
                              std::to_string(patience().count()) + " ms (" + error.what() + ")");
      }
      rest = between_attempts;
    } catch (const ProtocolError& refused) {
      is_over = !refused.details().retryable || Clock::now() >= end;
      if (is_over)
        throw ProtocolError(std::string(refused.what()) + " (" + loss + ")", refused.details());
      rest = between_hellos;
    }
  }
}

/// As long as the server accepts the connection and is silent, it is slow: that has no time-out.
bool SessionCore::hear_welcome(Clock::time_point end) {
  for (;;) {
    const auto kind = connection.receive(between_attempts, options.is_interrupted);
    if (!kind && is_interrupted()) return false;
    if (!kind && Clock::now() >= end && !connection.is_accepted()) {
      throw ConnectionError("no server answers at " + options.endpoint);
    }
    if (!kind) continue;
    if (*kind != Connection::Kind::kWelcome) {
      check_not_refused(*kind, connection.message());
      continue;  // a message of a later version
    }
    go_on(connection.message().welcome());
    return true;
  }
}

void SessionCore::go_on(const v1::Welcome& welcome) {
  check_welcome(welcome, options.endpoint);
  try {
    part.go_on(welcome, failures);
  } catch (const ProtocolError&) {
    is_over = true;
    throw;
  }
  const std::uint64_t seed_before = seed;
  read(welcome);
  if (seed != seed_before) read_reset();
  commanded = welcome.resumed().commanded();
  part.repeat();
  ++resumes;
  is_resumed = has_begun && !is_reset;
}

/// The first message of a resumed session may be the one that was answered before: the caller must
/// not see it twice, and the answer may have been lost. The same answer is sent again; the server
/// takes it or ignores it (L9).
bool SessionCore::repeats_answer(const Moment& next) {
  if (!is_resumed) return false;
  is_resumed = false;
  const bool is_other = now.epoch && next.epoch && *next.epoch != *now.epoch;
  if (next.tick < now.tick || is_other) {  // while there was no connection
    read_reset();
    is_restored = is_other && options.can_restore && next.tick > 0;
    if (is_restored) part.restore(commanded);
  }
  if (next.tick != now.tick || is_reset) return false;
  read_moment();  // handles point into the message, which may have other memory now
  send_answer();
  return true;
}

/// @return  false if it was interrupted
bool SessionCore::pause(milliseconds length) {
  const auto end = Clock::now() + length;
  while (!is_interrupted() && Clock::now() < end) {
    std::this_thread::sleep_for(std::min(length, between_attempts));
  }
  return !is_interrupted();
}

}  // namespace ziggurat
