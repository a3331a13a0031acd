#pragma once
// A share of the wall time: who has used it up waits until more has passed. What is used is processor
// time: a thread that other programs keep from running uses none.

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

  /// @param share  of the wall time, above 0
  /// @param most  that can be saved up
  TimeShare(double share, Seconds most) : share_(share), most_(most), left_(most) {}

  /// Times must not go back.
  bool has_some(Time now) {
    refill(now);
    return left_.count() > 0;
  }
  /// So much processor time was used. It may be more than there was: then that is owed.
  void charge(Seconds used) { left_ -= used; }
  /// Until has_some().
  Seconds time_until_some() const { return Seconds{std::max(0.0, -left_.count()) / share_}; }

 private:
  void refill(Time now) {
    left_ = std::min(most_, left_ + share_ * Seconds(now - filled_));
    filled_ = now;
  }

  double share_;
  Seconds most_, left_;
  Time filled_ = std::chrono::steady_clock::now();
};

}  // namespace ziggurat::network
