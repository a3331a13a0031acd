// SPDX-License-Identifier: MIT
#include "session_core.h"

#include <algorithm>
#include <stdexcept>

#include "text/printable.h"
#include "ziggurat/v1/envelope.h"

namespace ziggurat {
namespace {

ProtocolError displaced(const v1::Displaced& by) {
  ProtocolError::Details details;
  details.code = "DISPLACED";
  details.holder = by.by();
  return ProtocolError("DISPLACED: " + by.message(), details);
}

/// The tick did not wait for our answer, or already had it: the next observation arrives anyway.
/// @param may_have_jumped  the world was reset, or the session resumed: an answer that was sent
/// before may have
///                         a future tick
bool is_harmless(const v1::Error& error, bool may_have_jumped) {
  if (error.severity() == v1::Error::FATAL) return false;
  return error.severity() == v1::Error::WARNING || error.code() == v1::Error::STALE_TICK ||
         error.code() == v1::Error::DUPLICATE_TICK ||
         (error.code() == v1::Error::FUTURE_TICK && may_have_jumped);
}

}  // namespace

bool SessionCore::next() {
  fault.clear();
  try {
    return advance();
  } catch (const std::exception& error) {
    fault = error.what();
    throw;
  }
}

bool SessionCore::advance() {
  if (ending || is_over) return false;
  driven.by_this_thread();
  if (owes) answer();
  for (;;) {
    try {
      return wait();
    } catch (const ConnectionError& loss) {
      if (!connection.is_lost()) throw;
      if (!resume(loss.what())) return false;
    }
  }
}

void SessionCore::answer() {
  failures = part.take_failures();
  part.write(outgoing, now);
  owes = false;
  send_answer();
  part.sent();
}

void SessionCore::send_answer() {
  for (const v1::Leave& leave : failures) {
    v1::ClientMessage message;
    *message.mutable_leave() = leave;
    connection.send(message);
  }
  connection.send(outgoing);
}

const v1::Response& SessionCore::ask(v1::ClientMessage& question) {
  if (!owes || is_over || ending)
    throw std::logic_error("the world is asked at a tick, before its answer");
  question.mutable_request()->set_id(++last_question);
  connection.send(question);
  for (;;) {
    const auto kind = connection.receive(options.wait_timeout, options.is_interrupted);
    if (!kind) throw ConnectionError("no answer of " + options.endpoint + " to a question");
    const v1::ServerMessage& message = connection.message();
    if (*kind == Connection::Kind::kResponse && message.response().id() == last_question) {
      if (message.response().has_error()) throw to_exception(message.response().error());
      return message.response();
    }
    if (*kind == Connection::Kind::kError) {
      take(message.error());
    } else if (*kind != Connection::Kind::kHeartbeat && *kind != Connection::Kind::kResponse) {
      heard = kind;
      throw ConnectionError(options.endpoint +
                            ": the world has gone on without this tick's answer");
    }
  }
}

bool SessionCore::wait() {
  // Heartbeats come in between: they do not extend the time-out.
  const auto end = Clock::now() + options.wait_timeout.value_or(std::chrono::milliseconds{0});
  auto rest = options.wait_timeout;
  for (;;) {
    const auto kind =
        heard ? std::exchange(heard, {}) : connection.receive(rest, options.is_interrupted);
    if (rest) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
      rest = std::max(left, std::chrono::milliseconds{0});
    }
    if (!kind && is_interrupted()) return false;
    if (!kind) {
      throw ConnectionError("the server at " + options.endpoint + " sent no observation for " +
                            std::to_string(options.wait_timeout->count()) +
                            " ms after the answer to tick " + std::to_string(now.tick));
    }
    if (const auto next = part.moment(*kind, connection)) {
      if (repeats_answer(*next)) continue;
      take(*next);
      return true;
    }
    if (!hear(*kind)) return false;
  }
}

bool SessionCore::hear(Connection::Kind kind) {
  const v1::ServerMessage& message = connection.message();
  switch (kind) {
    case Connection::Kind::kEnd:
      read(message.end());
      return false;
    case Connection::Kind::kReset:
      read(message.reset());
      break;
    case Connection::Kind::kRestored:
      read(message.restored());
      break;
    case Connection::Kind::kError:
      take(message.error());
      break;
    case Connection::Kind::kDisplaced:
      is_over = true;
      throw displaced(message.displaced());
    default:
      part.hear(kind, message);  // or a heartbeat, or a message of a later version
  }
  return true;
}

void SessionCore::take(const v1::Error& error) {
  if (is_harmless(error, was_reset || resumes > 0)) {
    if (error.code() == v1::Error::DEADLINE_MISSED) {
      ++missed;
    } else if (error.severity() == v1::Error::WARNING) {
      part.warn(error);
    }
    part.remove(error.dropped().robots());
    // The first answer counts, unless it was for the world before the reset.
    if (error.code() != v1::Error::DUPLICATE_TICK || was_reset) part.repeat();
    return;
  }
  const bool is_fatal = error.severity() == v1::Error::FATAL;
  if (is_fatal && error.code() == v1::Error::OUT_OF_STATE) {
    connection.lose("the server does not know the connection");
  }
  is_over = is_fatal;
  if (!is_fatal &&
      has_begun) {  // the answer was discarded as a whole: the tick still waits for one
    owes = true;
    part.repeat();
  }
  throw to_exception(error);
}

void SessionCore::read_moment() {
  try {
    part.read(connection);
  } catch (const std::runtime_error& error) {
    throw ConnectionError(options.endpoint + ": " + error.what());
  }
}

void SessionCore::take(const Moment& next) {
  read_moment();
  now = next;
  event = is_restored  ? Event::restored
          : !has_begun ? Event::init
          : is_reset   ? Event::reset
                       : Event::step;
  has_begun = true;
  is_reset = is_resumed = is_restored = false;
  resumes_in_vain = 0;
  owes = true;
}

void SessionCore::read(const v1::End& end) {
  Ending::Reason reason = Ending::Reason::failed;
  if (end.reason() == v1::End::FINISHED) reason = Ending::Reason::finished;
  if (end.reason() == v1::End::INTERRUPTED) reason = Ending::Reason::interrupted;
  ending = Ending{reason, text::printable_part(end.message()), end.tick()};
}

void SessionCore::read(const v1::Reset& reset) {
  seed = reset.seed();
  read_reset();
}

void SessionCore::read_reset() {
  is_reset = was_reset = true;
  is_resumed = false;
  part.reset();
}

void SessionCore::read(const v1::Restored& restored) {
  snapshot = restored.snapshot();
  is_restored = was_reset = true;
  is_reset = is_resumed = false;
  part.reset();
  part.restore(restored.commanded());
}

void SessionCore::leave(v1::Leave::Reason reason, std::string_view message) {
  if (is_over || connection.is_lost()) return;
  is_over = true;
  for (v1::Leave& failed : part.take_failures()) {
    v1::ClientMessage last;
    last.mutable_leave()->Swap(&failed);
    connection.send(last);
  }
  v1::Leave& leave = *outgoing.mutable_leave();
  leave.set_reason(reason);
  leave.set_message(v1::valid_utf8(message));
  part.write(leave);
  connection.send(outgoing);
}

void SessionCore::leave_at_the_end() noexcept {
  try {
    if (std::uncaught_exceptions() > exceptions) {
      leave(v1::Leave::FAILED, fault.empty() ? "an exception ended the controller" : fault);
    } else {
      leave(v1::Leave::DONE, {});
    }
  } catch (const std::exception&) {
    // The server is gone.
  }
}

}  // namespace ziggurat
