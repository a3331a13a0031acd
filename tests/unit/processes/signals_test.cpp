#include "processes/signals.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

namespace ziggurat::processes {
namespace {

bool readable(const Signals& signals) {
  pollfd descriptor{signals.descriptor(), POLLIN, 0};
  return ::poll(&descriptor, 1, 0) == 1;
}

TEST(Signals, ArriveOnTheDescriptorAndNowhereElse) {
  Signals signals;
  EXPECT_FALSE(readable(signals));
  ::kill(::getpid(), SIGINT);
  ::kill(::getpid(), SIGCHLD);
  EXPECT_TRUE(readable(signals));
  const auto arrived = signals.take();
  EXPECT_EQ(arrived.interruptions, 1);
  EXPECT_TRUE(arrived.child);
  EXPECT_FALSE(readable(signals));
  EXPECT_EQ(signals.take().interruptions, 0);
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
