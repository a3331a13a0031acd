// SPDX-License-Identifier: MIT
#pragma once
// Waits without sleep for answers that come at once: a processor that fell asleep takes longer to
// wake than a small tick takes to compute. No other thread is kept from a processor by it.

#include <chrono>
#include <cstddef>
#include <string>

#include "posix/descriptor.h"

namespace ziggurat::network {

class AwakeWait {
 public:
  static constexpr std::chrono::microseconds longest{200};

  /// @param processors  that this process may use
  /// @param load  file of the system with the number of threads that run or are ready to
  explicit AwakeWait(std::size_t processors = usable_processors(),
                     const std::string& load = "/proc/loadavg");

  /// Whether it is worth a try: some processor is left, and the last tries were no waste.
  /// @param awaited  answers, each of which is computed by a processor
  bool is_worth_it(std::size_t awaited);

  /// Looks again and again. True if `look` returned true; false when other threads want the
  /// processor, or after `longest`.
  bool until(const auto& look) {
    const auto end = Clock::now() + longest;
    int crowded = 0;
    do {
      if (look()) return succeed();
      crowded = is_crowded() ? crowded + 1 : 0;
    } while (crowded < looks_until_crowded && Clock::now() < end);
    return fail(crowded > 0);
  }

 private:
  using Clock = std::chrono::steady_clock;
  // Two threads that wake each other are both ready for a moment, which is no crowd.
  static constexpr int looks_until_crowded = 4;

  static std::size_t usable_processors();
  /// More threads run or are ready than there are processors.
  bool is_crowded() const;
  bool succeed();
  bool fail(bool is_crowded);

  std::size_t processors_;
  posix::Descriptor load_;
  unsigned pause_ = 0;  // calls of is_worth_it() without a try, after each waste twice as many
  unsigned left_ = 0;   // of them
};

}  // namespace ziggurat::network
