#include "network/barrier/seats.h"

namespace ziggurat::network {

void Seats::add(Time now, bool is_skipped) {
  Seat& seat = seats_.emplace_back();
  seat.free_since = now;
  seat.is_skipped = is_skipped;
  ++free_;
  if (is_skipped) ++skipped_;
}

void Seats::take(std::size_t robot, SessionId session) {
  Seat& seat = seats_[robot];
  --free_;
  if (seat.is_skipped) --skipped_;
  seat.is_skipped = false;
  seat.was_held = true;
  seat.holder = session;
  seat.claimant = SessionId::none;
}

void Seats::release(std::size_t robot, SessionId claimant, Time since, bool is_skipped) {
  Seat& seat = seats_[robot];
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

void Seats::skip(std::size_t robot) {
  seats_[robot].is_skipped = true;
  ++skipped_;
}

void Seats::begin_tick() {
  if (skipped_ == 0) return;
  for (Seat& seat : seats_) seat.is_skipped = false;
  skipped_ = 0;
}

void Seats::restart(Time now) {
  for (Seat& seat : seats_) seat.free_since = now;
}

}  // namespace ziggurat::network
