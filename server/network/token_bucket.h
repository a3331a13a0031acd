// SPDX-License-Identifier: MIT
#pragma once
// Token bucket: full at the start, refilled by time. Messages, sentences or time take tokens from
// it.

#include <algorithm>
#include <chrono>

namespace ziggurat::network {

struct Rate {
  double per_second = 1000;
  double at_once = 2000;  ///< tokens of a full bucket
};

class TokenBucket {
 public:
  using Time = std::chrono::steady_clock::time_point;

  TokenBucket(const Rate& rate, Time now) : tokens_(rate.at_once), filled_(now) {}

  /// Adds what has flowed in. Times must not go back. @returns the tokens; below 0: they are owed
  double refill(const Rate& rate, Time now) {
    const std::chrono::duration<double> elapsed = now - filled_;
    tokens_ = std::min(rate.at_once, tokens_ + elapsed.count() * rate.per_second);
    filled_ = now;
    return tokens_;
  }
  /// Takes one, if there is one. Times must not go back.
  bool take(const Rate& rate, Time now) {
    if (refill(rate, now) < 1) return false;
    tokens_ -= 1;
    return true;
  }
  /// Takes so many, which may be owed. @pre the bucket was refilled for this moment
  void charge(double tokens) { tokens_ -= tokens; }
  /// Returns tokens that were taken a moment ago.
  void give_back(double tokens) { tokens_ += tokens; }

 private:
  double tokens_;
  Time filled_;
};

}  // namespace ziggurat::network
