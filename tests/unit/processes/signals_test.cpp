// SPDX-License-Identifier: MIT
#include "processes/signals.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>

#include "processes/child_process.h"

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

TEST(Signals, ALimitOfProcessorTimeIsAnInterruption) {
  Signals signals;
  ::kill(::getpid(), SIGXCPU);
  ASSERT_TRUE(readable(signals, 5000));
  EXPECT_EQ(signals.take().interruptions, 1);
}

TEST(Signals, EndAProgramThatDoesNotReact) {
  EXPECT_EXIT(
      {
        Signals signals;
        ::kill(::getpid(), SIGTERM);
        for (;;) ::pause();
      },
      testing::ExitedWithCode(130), "did not wait");
}

TEST(Signals, TheEndOfAnInputIsAnInterruption) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  {
    Signals signals;
    signals.interrupt_at_end_of(ends[0]);
    ASSERT_EQ(::write(ends[1], "text", 4), 4);  // no end
    ::kill(::getpid(), SIGCHLD);
    ASSERT_TRUE(readable(signals, 5000));
    EXPECT_EQ(signals.take().interruptions, 0);
    ::close(ends[1]);
    int interruptions = 0;
    while (interruptions == 0 && readable(signals, 5000))
      interruptions += signals.take().interruptions;
    EXPECT_EQ(interruptions, 1);
    EXPECT_FALSE(readable(signals, 50)) << "once";
  }
  ::close(ends[0]);
}

TEST(Signals, WhatNohupIgnoresStaysIgnored) {
  EXPECT_EXIT(
      {
        ::signal(SIGHUP, SIG_IGN);
        Signals signals;
        ::kill(::getpid(), SIGHUP);
        ::kill(::getpid(), SIGCHLD);  // behind it
        while (!signals.take().child) readable(signals, 5000);
        std::exit(signals.take().interruptions);
      },
      testing::ExitedWithCode(0), "");
}

TEST(Signals, ChildrenEndAlsoIfTheParentIgnoredThem) {
  EXPECT_EXIT(
      {
        ::signal(SIGCHLD, SIG_IGN);
        Signals signals;
        ChildProcess child({{"/bin/sh", "-c", "exit 3"}, {}});
        while (!child.poll()) readable(signals, 100);
        std::exit(child.exit_code());
      },
      testing::ExitedWithCode(3), "");
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
