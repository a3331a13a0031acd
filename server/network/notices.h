// SPDX-License-Identifier: MIT
#pragma once
// Sentences for people that peers can cause any number of times.

#include <chrono>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "network/token_bucket.h"

namespace ziggurat::network {

/// The first 20 are told at once, then one a second, with the number of those before it that were
/// not.
class Notices {
 public:
  using Time = TokenBucket::Time;
  static constexpr Rate rate{1, 20};

  /// @param sentence  with its full stop, if it has one
  /// @param now  must not go back
  void add(std::string sentence, Time now) {
    last_ = std::move(sentence);
    ++untold_;
    tell(now);
  }
  /// The last one that was not told is told now, if it is its time.
  void tell_last(Time now) {
    if (untold_ > 0) tell(now);
  }
  /// Sentences to print since the last call, in order.
  std::vector<std::string> take() { return std::exchange(told_, {}); }

 private:
  void tell(Time now) {
    if (!bucket_.take(rate, now)) return;
    const std::uint64_t others = std::exchange(untold_, 0) - 1;
    if (others > 0) last_ += " (" + std::to_string(others) + " more before it.)";
    told_.push_back(std::move(last_));
  }

  TokenBucket bucket_{rate, Time{}};
  std::vector<std::string> told_;
  std::string last_;
  std::uint64_t untold_ = 0;  // the last one and those before it
};

}  // namespace ziggurat::network
