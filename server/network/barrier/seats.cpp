#include "network/barrier/seats.h"

#include <algorithm>

namespace ziggurat::network {

void Seats::add(Time now, bool is_skipped) {
  Seat& seat = seats_.emplace_back();
  seat.free_since = now;
  seat.is_skipped = is_skipped;
  has_changes_ = true;
  ++free_;
  if (is_skipped) ++skipped_;
}

/// The tick does not wait for the free robot any more.
void Seats::wait_over(Seat& seat, Time now) {
  if (!seat.is_skipped) seat.waited += now - std::max(seat.free_since, begun_);
  has_changes_ = true;
}

void Seats::take(std::size_t robot, SessionId session, Time now) {
  Seat& seat = seats_[robot];
  wait_over(seat, now);
  --free_;
  if (seat.is_skipped) --skipped_;
  seat.is_skipped = false;
  seat.was_held = true;
  seat.holder = session;
  seat.claimant = SessionId::none;
}

void Seats::release(std::size_t robot, SessionId claimant, Time since, bool is_skipped,
                    std::chrono::nanoseconds waited) {
  Seat& seat = seats_[robot];
  seat.waited += waited;
  has_changes_ = true;
  ++free_;
  if (is_skipped) ++skipped_;
  seat.is_skipped = is_skipped;
  seat.free_since = since;
  seat.holder = SessionId::none;
  seat.claimant = claimant;
}

void Seats::leave(std::size_t robot) {
  Seat& seat = seats_[robot];
  if (seat.has_left) return;
  if (seat.holder == SessionId::none) --free_;
  if (seat.is_skipped) --skipped_;
  seat.has_left = true;
  seat.is_skipped = false;
  seat.holder = SessionId::none;
  seat.claimant = SessionId::none;
}

void Seats::skip(std::size_t robot, Time now) {
  wait_over(seats_[robot], now);
  seats_[robot].is_skipped = true;
  ++skipped_;
}

void Seats::begin_tick(Time now) {
  begun_ = now;
  if (!has_changes_) return;
  has_changes_ = false;
  skipped_ = 0;
  for (Seat& seat : seats_) {
    seat.is_skipped = false;
    seat.waited = {};
  }
}

void Seats::restart(Time now) {
  begun_ = now;
  for (Seat& seat : seats_) {
    seat.free_since = now;
    seat.waited = {};
  }
}

}  // namespace ziggurat::network
