#include "network/reception.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

#include "wire/fault.h"

namespace ziggurat::network {
namespace {

using std::chrono::milliseconds;
using wire::ErrorCode;
using wire::Severity;

constexpr std::size_t most_bytes = std::size_t{64} << 20;  // of all Hellos that wait
constexpr int messages_at_once = 1000;                     // between looks at the time

}  // namespace

Reception::Reception(const Config& config, GiveUp give_up)
    : max_visitors_(config.max_sessions),
      max_message_bytes_(config.max_message_bytes),
      interval_(config.heartbeat),
      socket_(std::make_unique<Socket>(config)),
      endpoints_(socket_->endpoints()),
      give_up_(std::move(give_up)),
      wake_(::eventfd(0, EFD_CLOEXEC)) {
  if (wake_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
  // Signals are for whoever started us: the new thread gets none.
  sigset_t all, before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([this] { serve(); });
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

Reception::~Reception() {
  stop();
  dismiss();
  ::close(wake_);
}

void Reception::dismiss() {
  for (const Visitor& visitor : visitors_) {
    refuse(visitor, ErrorCode::out_of_state, "There is no world: it could not be loaded.");
  }
  visitors_.clear();
  socket_.reset();
}

/// What the thread did is visible from here on, so the socket may change hands.
void Reception::stop() {
  if (!thread_.joinable()) return;
  is_over_ = true;
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = ::write(wake_, &one, sizeof one);
  thread_.join();
}

Reception::HandedOver Reception::hand_over() {
  stop();
  // Who went away meanwhile shall have no session, and no lease.
  say(1, "The world is there.");
  std::erase_if(visitors_,
                [&](const Visitor& each) { return tell_loading(each) == Delivery::unreachable; });
  return {std::move(socket_), std::exchange(visitors_, {})};
}

void Reception::say(double progress, std::string message) {
  const std::lock_guard lock(mutex_);
  progress_ = progress;
  message_ = std::move(message);
}

/// A wait may also end because the process was stopped and goes on.
bool Reception::is_readable() const {
  pollfd descriptor{give_up_.descriptor, POLLIN, 0};
  return ::poll(&descriptor, 1, 0) > 0;
}

void Reception::serve() {
  const std::array descriptors{wake_, give_up_.descriptor};
  const std::span watched(descriptors.data(), give_up_.end ? 2U : 1U);
  auto next = Clock::now() + interval_;
  while (!is_over_) {
    const auto rest = std::chrono::ceil<milliseconds>(next - Clock::now());
    const auto ready = socket_->poll({std::max(rest, milliseconds{0}), watched});
    if (ready == Socket::Ready::woken && !is_over_ && give_up_.end && is_readable()) {
      dismiss();
      return give_up_.end();
    }
    for (int i = 0; i < messages_at_once && socket_->receive(received_); ++i) take();
    if (Clock::now() < next) continue;
    std::erase_if(visitors_, [&](const Visitor& each) {
      const bool is_gone = tell_loading(each) == Delivery::unreachable;
      if (is_gone) visitor_bytes_ -= each.hello.size();
      return is_gone;
    });
    next = Clock::now() + interval_;
  }
}

void Reception::take() {
  if (received_.bytes.size() > max_message_bytes_) {
    return fail(ErrorCode::too_large,
                fmt::format("The message has {} bytes; {} are allowed.", received_.bytes.size(),
                            max_message_bytes_),
                Severity::fatal);
  }
  const auto kind =
      received_.is_single_frame ? inbox_.parse(received_.bytes) : wire::Inbox::Kind::malformed;
  if (kind == wire::Inbox::Kind::malformed) {
    return fail(ErrorCode::malformed,
                "Not a ClientMessage of ziggurat.v1: one ZeroMQ frame holds one message.",
                Severity::fatal);
  }
  const auto known = std::ranges::find(visitors_, received_.peer, &Visitor::peer);
  if (known != visitors_.end()) return take_from(*known, kind);
  if (kind == wire::Inbox::Kind::hello) return take_hello();
  fail(ErrorCode::out_of_state, "The first message of a session is Hello.", Severity::fatal);
}

void Reception::take_hello() {
  Visitor visitor{received_.peer, std::string(received_.bytes), received_.roles};
  if (visitors_.size() >= max_visitors_ || visitor_bytes_ + visitor.hello.size() > most_bytes) {
    return refuse(visitor, ErrorCode::too_many, "Too many wait for the world already.");
  }
  visitor_bytes_ += visitor.hello.size();
  visitors_.push_back(std::move(visitor));
  tell_loading(visitors_.back());
}

/// From somebody whose Hello waits.
void Reception::take_from(const Visitor& visitor, wire::Inbox::Kind kind) {
  if (kind == wire::Inbox::Kind::heartbeat) {
    outbox_.heartbeat(inbox_.heartbeat());
    tell(received_.peer, visitor.hello);
  } else if (kind == wire::Inbox::Kind::leave) {
    visitor_bytes_ -= visitor.hello.size();
    visitors_.erase(visitors_.begin() + (&visitor - visitors_.data()));
  } else {
    fail(ErrorCode::out_of_state, "The world is loading, and the Hello waits for it.",
         Severity::discard);
  }
}

/// Sends what is in hand in the form that the peer talks.
Delivery Reception::tell(const std::string& peer, std::string_view their_form) {
  outbox_.encode(wire::encoding_of(their_form));
  return socket_->send(peer, outbox_);
}

Delivery Reception::tell_loading(const Visitor& visitor) {
  {
    const std::lock_guard lock(mutex_);
    outbox_.loading(progress_, message_);
  }
  return tell(visitor.peer, visitor.hello);
}

void Reception::refuse(const Visitor& visitor, ErrorCode code, std::string message) {
  wire::Refusal refusal{wire::make_fault(code, {}, std::move(message)), {}, {}};
  refusal.fault.severity = Severity::fatal;
  refusal.fault.retryable = code == ErrorCode::too_many;
  outbox_.refusal(refusal);
  tell(visitor.peer, visitor.hello);
}

void Reception::fail(ErrorCode code, std::string message, Severity severity) {
  auto fault = wire::make_fault(code, {}, std::move(message));
  fault.severity = severity;
  outbox_.error(fault);
  tell(received_.peer, received_.bytes);
}

}  // namespace ziggurat::network
