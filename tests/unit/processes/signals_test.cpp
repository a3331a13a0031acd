#include "processes/signals.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>

namespace ziggurat::processes {
namespace {

/// @param patience_ms  a thread of the signals receives them
bool readable(const Signals& signals, int patience_ms = 0) {
  pollfd descriptor{signals.descriptor(), POLLIN, 0};
  return ::poll(&descriptor, 1, patience_ms) == 1;
}

TEST(Signals, ArriveOnTheDescriptorAndNowhereElse) {
  Signals signals;
  EXPECT_FALSE(readable(signals));
  ::kill(::getpid(), SIGINT);
  ::kill(::getpid(), SIGCHLD);
  Signals::Arrived arrived;
  while (arrived.interruptions == 0 || !arrived.child) {
    ASSERT_TRUE(readable(signals, 5000));
    const auto more = signals.take();
    arrived.interruptions += more.interruptions;
    arrived.child |= more.child;
  }
  EXPECT_EQ(arrived.interruptions, 1);
  EXPECT_FALSE(readable(signals));
  EXPECT_EQ(signals.take().interruptions, 0);
}

TEST(Signals, EndAProgramThatDoesNotReact) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EXIT(
      {
        Signals signals;
        ::kill(::getpid(), SIGTERM);
        for (;;) ::pause();
      },
      testing::ExitedWithCode(130), "did not wait");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(3));
}

TEST(Signals, PendingOnesDoNotStrikeAfterwards) {
  {
    Signals signals;
    ::kill(::getpid(), SIGTERM);
  }
  SUCCEED() << "still here";
}

}  // namespace
}  // namespace ziggurat::processes
