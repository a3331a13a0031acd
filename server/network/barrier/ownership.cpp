// SPDX-License-Identifier: MIT
#include "network/barrier/ownership.h"

#include <algorithm>

namespace ziggurat::network {

void Ownership::add(Time now, InTick in_tick) {
  Entry& entry = entries_.emplace_back();
  entry.free_since = now;
  entry.is_skipped = in_tick == InTick::skipped;
  has_changes_ = true;
  ++free_;
  if (entry.is_skipped) ++skipped_;
}

/// The tick does not wait for the free robot any more.
void Ownership::wait_over(Entry& entry, Time now) {
  if (!entry.is_skipped) entry.waited += now - std::max(entry.free_since, begun_);
  has_changes_ = true;
}

void Ownership::take(std::size_t robot, SessionId session, Time now) {
  Entry& entry = entries_[robot];
  wait_over(entry, now);
  --free_;
  if (entry.is_skipped) --skipped_;
  entry.is_skipped = false;
  entry.was_held = true;
  entry.holder = session;
  entry.claimant = SessionId::none;
}

void Ownership::release(std::size_t robot, SessionId claimant, Time since, InTick in_tick,
                        std::chrono::nanoseconds waited) {
  Entry& entry = entries_[robot];
  entry.waited += waited;
  has_changes_ = true;
  ++free_;
  entry.is_skipped = in_tick == InTick::skipped;
  if (entry.is_skipped) ++skipped_;
  entry.free_since = since;
  entry.holder = SessionId::none;
  entry.claimant = claimant;
}

void Ownership::leave(std::size_t robot) {
  Entry& entry = entries_[robot];
  if (entry.has_left) return;
  if (entry.holder == SessionId::none) --free_;
  if (entry.is_skipped) --skipped_;
  entry.has_left = true;
  entry.is_skipped = false;
  entry.holder = SessionId::none;
  entry.claimant = SessionId::none;
}

void Ownership::skip(std::size_t robot, Time now) {
  wait_over(entries_[robot], now);
  entries_[robot].is_skipped = true;
  ++skipped_;
}

void Ownership::begin_tick(Time now) {
  begun_ = now;
  if (!has_changes_) return;
  has_changes_ = false;
  skipped_ = 0;
  for (Entry& entry : entries_) {
    entry.is_skipped = false;
    entry.waited = {};
  }
}

void Ownership::restart(Time now) {
  begun_ = now;
  for (Entry& entry : entries_) {
    entry.free_since = now;
    entry.waited = {};
  }
}

}  // namespace ziggurat::network
