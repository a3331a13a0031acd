#pragma once
// The processor time of this thread: one that other programs keep from running uses none.

#include <time.h>

#include <chrono>
#include <cstdint>
#include <ratio>

namespace ziggurat::network {

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

}  // namespace ziggurat::network
