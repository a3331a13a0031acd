// SPDX-License-Identifier: MIT
#include "connection.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "ziggurat/error.h"

namespace ziggurat {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr milliseconds slice{500};  // between checks of whether the connection is open

}  // namespace

Connection::Connection(const SessionOptions& options)
    : options_(options), transport_(make_transport(options)) {}

Connection::~Connection() {
  if (!is_lost_) transport_->linger();
}

void Connection::reconnect() {
  if (!lost_transport_) lost_transport_ = std::move(transport_);
  transport_ = make_transport(options_);
  is_lost_ = false;
  longest_silence_ = silence_ = milliseconds{0};
}

void Connection::begin_session(milliseconds silence) {
  lost_transport_.reset();
  longest_silence_ = silence;
}

void Connection::send(const v1::ClientMessage& message) {
  transport_->send(message.ByteSizeLong(), [&](char* to) {
    message.SerializeWithCachedSizesToArray(reinterpret_cast<std::uint8_t*>(to));
  });
}

std::optional<Connection::Kind> Connection::receive(std::optional<milliseconds> timeout,
                                                    const std::function<bool()>& is_interrupted) {
  const auto end = Clock::now() + timeout.value_or(milliseconds{0});
  milliseconds rest = timeout.value_or(slice);
  for (;;) {
    const auto before = Clock::now();
    const milliseconds longest = std::clamp(rest, milliseconds{0}, slice);
    if (transport_->receive(longest)) return parse();
    // A program that was stopped meanwhile has not waited.
    check_alive(std::min(longest, std::chrono::ceil<milliseconds>(Clock::now() - before)));
    if (transport_->was_closed()) {
      // Messages that the server sent before may still be in the queue.
      if (transport_->receive(milliseconds{0})) return parse();
      lose("the server closed the connection");
    }
    if (is_interrupted && is_interrupted()) return std::nullopt;
    if (!timeout) continue;
    rest = std::chrono::ceil<milliseconds>(end - Clock::now());
    if (rest.count() <= 0) return std::nullopt;
  }
}

void Connection::check_alive(milliseconds waited) {
  silence_ += waited;
  if (longest_silence_.count() == 0 || silence_ < longest_silence_) return;
  lose("the server has been silent for " + std::to_string(silence_.count()) + " ms");
}

void Connection::lose(const std::string& why) {
  is_lost_ = true;
  throw ConnectionError(options_.endpoint + ": " + why);
}

}  // namespace ziggurat
