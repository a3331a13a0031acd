// SPDX-License-Identifier: MIT
#pragma once
// Delays and losses of messages that are injected on purpose, as if by a slow network.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace ziggurat::network {

/// Delay and loss of messages in one direction; wall time.
struct Disturbance {
  std::chrono::nanoseconds latency{0};  ///< each is held back for so long,
  std::chrono::nanoseconds jitter{0};   ///< more or less by up to this; at most `latency`
  double loss = 0;                      ///< share that is lost, 0 to 1

  bool any() const { return latency.count() > 0 || loss > 0; }
  bool operator==(const Disturbance&) const = default;
};

/// Disturbance of a controller's messages, to it and from it.
struct Injection {
  Disturbance observations;
  Disturbance commands;

  bool any() const { return observations.any() || commands.any(); }
  bool operator==(const Injection&) const = default;
};

/// Messages that were lost on purpose.
struct Lost {
  std::uint64_t observations = 0;
  std::uint64_t commands = 0;
};

enum class Direction { observations, commands };

/// Disturbance of one message.
struct Effect {
  std::chrono::nanoseconds delay{0};
  bool is_lost = false;
};

/// Depends on nothing but the arguments: the order in which clients answer changes nothing.
/// Delays are uniform in latency - jitter … latency + jitter.
/// @param path  names the connection: controller and robot
Effect draw_effect(const Disturbance& disturbance, std::uint64_t seed, std::string_view path,
                   Direction direction, std::uint64_t tick);

/// Messages under way in one direction. None overtakes another.
template <class Message>
class DelayLine {
 public:
  using Time = std::chrono::steady_clock::time_point;

  bool empty() const { return held_.empty(); }
  std::size_t size() const { return held_.size(); }
  /// When the first of them arrives; Time::max() if there is none.
  Time due() const { return held_.empty() ? Time::max() : held_.front().first; }

  /// Puts a message behind the others.
  void push(Time due, Message message) {
    if (!held_.empty()) due = std::max(due, held_.back().first);
    held_.emplace_back(due, std::move(message));
  }
  /// Takes the first message, if it has arrived by now.
  std::optional<Message> pop(Time now) {
    if (held_.empty() || held_.front().first > now) return std::nullopt;
    std::optional<Message> message(std::move(held_.front().second));
    held_.pop_front();
    return message;
  }
  /// All of them arrive now.
  void hurry(Time now) {
    for (auto& [due, message] : held_) due = std::min(due, now);
  }
  void clear() { held_.clear(); }

 private:
  std::deque<std::pair<Time, Message>> held_;
};

}  // namespace ziggurat::network
