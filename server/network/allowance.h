#pragma once
// How many messages a connection may send: so many a second, so many at once.

#include <algorithm>
#include <chrono>

namespace ziggurat::network {

struct Rate {
  double per_second = 1000;
  double at_once = 2000;
};

/// A bucket of tokens: full at the start, refilled by time, one taken by each message.
class Allowance {
 public:
  using Time = std::chrono::steady_clock::time_point;

  Allowance(const Rate& rate, Time now) : tokens_(rate.at_once), filled_(now) {}

  /// Whether there is one more. Times must not go back.
  bool take(const Rate& rate, Time now) {
    tokens_ = at(rate, now);
    filled_ = now;
    if (tokens_ < 1) return false;
    tokens_ -= 1;
    return true;
  }
  /// The last message counts for more, which may be owed.
  void charge(double tokens) { tokens_ -= tokens; }
  /// The last message was welcome.
  void give_back(double tokens) { tokens_ += tokens; }
  bool is_full(const Rate& rate, Time now) const { return at(rate, now) >= rate.at_once; }

 private:
  double at(const Rate& rate, Time now) const {
    const std::chrono::duration<double> elapsed = now - filled_;
    return std::min(rate.at_once, tokens_ + elapsed.count() * rate.per_second);
  }

  double tokens_;
  Time filled_;
};

}  // namespace ziggurat::network
