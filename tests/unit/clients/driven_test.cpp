// SPDX-License-Identifier: MIT
#include "driven.h"

#include <gtest/gtest.h>

#include <chrono>
#include <future>

namespace ziggurat {
namespace {

using Ids = std::vector<std::string>;
using std::chrono::milliseconds;

TEST(Driven, ByTheThreadThatWaitsForItsTicks) {
  Driven session("tcp://a");
  session.is("r0");
  session.by_this_thread();
  EXPECT_EQ(driven_here("tcp://a"), Ids{"r0"});
  EXPECT_EQ(driven_here("tcp://b"), Ids{});
  EXPECT_EQ(std::async(std::launch::async, driven_here, "tcp://a").get(), Ids{});
  std::async(std::launch::async, [&] { session.by_this_thread(); }).get();
  EXPECT_EQ(driven_here("tcp://a"), Ids{});
}

TEST(Driven, OneThatNoThreadHasBegunIsTheCallersAfterASecond) {
  Driven session("tcp://a");
  EXPECT_EQ(driven_here("tcp://a"), Ids{}) << "it has no robots yet";
  session.is("r0");
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(driven_here("tcp://a"), Ids{"r0"});
  EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(900));
  const auto starting = std::async(std::launch::async, [&] {
    std::this_thread::sleep_for(milliseconds(50));
    session.by_this_thread();
  });
  EXPECT_EQ(driven_here("tcp://a"), Ids{}) << "a thread was just starting";
}

TEST(Driven, AsLongAsTheSessionExists) {
  {
    Driven session("tcp://a");
    session.is("r0");
    session.by_this_thread();
  }
  EXPECT_EQ(driven_here("tcp://a"), Ids{});
}

}  // namespace
}  // namespace ziggurat
