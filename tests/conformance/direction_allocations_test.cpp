// SPDX-License-Identifier: MIT
// Questions of the server about directors at each tick take no memory.

#include "allocations/allocations.h"
#include "directed_run.h"

namespace ziggurat::network {
namespace {

TEST_F(Directing, WhatIsAskedAtEachTickAllocatesNothing) {
  begin();
  peers.say("p", direction(5));
  peers.say("q", direction(5));
  ASSERT_EQ(directions(peers.barrier).size(), 2U);
  const std::size_t before = testing::allocations();
  const std::size_t count = directions(peers.barrier).size();
  const bool is_wanted = wants_contacts(peers.barrier);
  EXPECT_EQ(testing::allocations(), before);
  EXPECT_EQ(count, 2U);
  EXPECT_FALSE(is_wanted);
}

}  // namespace
}  // namespace ziggurat::network
