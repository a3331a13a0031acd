#pragma once
// A share of the wall time: who has used it up waits until more has passed. What is used is
// processor time: a thread that other programs keep from running uses none.

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <ratio>

namespace ziggurat::network {

/// The processor time of this thread.
struct ThreadClock {
  using rep = std::int64_t;
  using period = std::nano;
  using duration = std::chrono::duration<rep, period>;
  using time_point = std::chrono::time_point<ThreadClock>;
  static constexpr bool is_steady = true;
  static time_point now() {
    timespec time{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return time_point(std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec));
  }
};

class TimeShare {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Seconds = std::chrono::duration<double>;

  /// What was used up begins again with this much, so that few turns are taken rather than many
  /// small ones.
  static constexpr Seconds least{0.5e-3};
  /// More than that is not owed, whatever was used at once: a question that takes longer, in a world of many
  /// thousands, keeps others waiting for some seconds, not for minutes.
  static constexpr Seconds most_debt{20e-3};

  /// @param share  of the wall time, above 0
  /// @param most  that can be saved up, not below `least`
  TimeShare(double share, Seconds most) : share_(share), most_(most), left_(most) {}

  /// Times must not go back.
  bool has_some(Time now) {
    refill(now);
    is_used_up_ = left_.count() <= 0 || (is_used_up_ && left_ < least);
    return !is_used_up_;
  }
  /// So much processor time was used. It may be more than there was: then that is owed.
  void charge(Seconds used) { left_ = std::max(left_ - used, -most_debt); }
  /// Until has_some(), if it was false.
  Seconds time_until_some() const { return std::max(Seconds{0}, least - left_) / share_; }

 private:
  void refill(Time now) {
    left_ = std::min(most_, left_ + share_ * Seconds(now - filled_));
    filled_ = now;
  }

  double share_;
  Seconds most_, left_;
  bool is_used_up_ = false;
  Time filled_ = std::chrono::steady_clock::now();
};

}  // namespace ziggurat::network
