// SPDX-License-Identifier: MIT
// Stacks the first block that it finds on top of the second, as
// scenes/prototype_srocs_system_arcontrol.lua does:
//   ziggurat run scenes/prototype_srocs_system.argos --controller robot=example_stacking

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>

#include "../construction/builder.h"

namespace stacking {
namespace {

using construction::block, construction::Builder, construction::Docking, construction::tick;

constexpr double clearance = 0.03;          // lift, on approach without a block [m]
constexpr double gap = 0.003;               // over the block when the magnets are energised [m]
constexpr double carrying = block + 0.017;  // lift, with a block carried over another one [m]
constexpr double placed = block - 0.0002;   // lift, with the carried block on top of another [m]

constexpr std::uint8_t picked_up[] = {1};  // to the attached block

enum class State {
  start,
  approach,
  retreat,
  search,
  lower,
  energise,
  raise,
  signal,
  look,
  let_go,
  place,
  release,
  rise,
  back_off,
  done
};
constexpr const char* names[] = {"start",    "approach", "retreat", "search",   "lower",
                                 "energise", "raise",    "signal",  "look",     "let_go",
                                 "place",    "release",  "rise",    "back_off", "done"};

/// A state machine. Its inputs are proximity, camera, radio and encoders; it does not know
/// positions.
class Stacker {
 public:
  explicit Stacker(ziggurat::Robot& robot) : robot_(robot), builder_(robot) {}

  void restart() { state_ = State::start, since_ = 0, blocks_met_ = 0; }

  void step() {
    ++since_;
    const State next = blocks_met_ < 2 ? fetch() : put_down();
    if (next != state_) {
      state_ = next;
      since_ = 0;
      robot_.log(names[static_cast<int>(state_)]);
    }
    builder_.move_lift();
  }

 private:
  double seconds() const { return since_ * tick; }
  State fetch();
  State put_down();
  State approach();
  State retreat();
  State search();

  ziggurat::Robot& robot_;
  Builder builder_;
  State state_ = State::start;
  int since_ = 0;  // ticks in this state
  int blocks_met_ = 0;
};

State Stacker::approach() {
  builder_.lift_to(blocks_met_ == 0 ? clearance : carrying, 0.05);
  switch (builder_.dock(0.05)) {
    case Docking::under_way:
      return state_;
    case Docking::askew:
      return State::retreat;
    case Docking::lost:
      return State::search;
    case Docking::docked:
      break;
  }
  return ++blocks_met_ == 1 ? State::lower : State::place;
}

/// Drives back for another approach.
State Stacker::retreat() {
  const bool away = builder_.back_away(0.04);
  if (!away && seconds() <= 10) return state_;
  if (!away) builder_.forget_face();
  builder_.stop();
  return State::approach;
}

/// Turns to both sides, each time farther, until the camera sees a face.
State Stacker::search() {
  double turn = 0.2, length = 2, until_end = 2;
  while (seconds() > until_end) {
    turn = -turn;
    length *= 2;
    until_end += length;
  }
  builder_.drive(0, turn);
  if (!builder_.nearest_face()) return state_;
  builder_.stop();
  return State::approach;
}

/// Until it finds the second block.
State Stacker::fetch() {
  switch (state_) {
    case State::start:
      builder_.set_current(-1);
      return builder_.lift_to(clearance, 0.05) ? State::approach : state_;
    case State::approach:
      return approach();
    case State::retreat:
      return retreat();
    case State::search:
      return search();
    case State::lower:
      return builder_.lift_to(gap - 0.0005, 0.03) ? State::energise : state_;
    case State::energise:
      // Slowly: before the block jumps, its weight on the floor becomes less and it aligns.
      builder_.set_current(std::min(1.0, -1 + seconds()));
      if (seconds() <= 2.5) return state_;
      return builder_.holds() ? State::raise : State::let_go;
    case State::raise:
      if (!builder_.lift_to(carrying, 0.03)) return state_;
      return builder_.holds() ? State::signal : State::let_go;
    case State::signal:
      builder_.set_current(0);
      builder_.send(picked_up);
      return seconds() >= 1 ? State::look : state_;
    case State::look:
      if (builder_.nearest_face()) return State::approach;
      builder_.drive(0.03, 0);
      if (seconds() <= 3) return state_;
      builder_.stop();
      return State::search;
    default:  // let_go
      builder_.set_current(-1);
      builder_.lift_to(clearance, 0.03);
      if (seconds() <= 3) return state_;
      blocks_met_ = 0;
      return State::retreat;
  }
}

State Stacker::put_down() {
  switch (state_) {
    case State::place:
      // Slowly: the carried block pulls the lower one, which aligns with it.
      return builder_.lift_to(placed, 0.008) ? State::release : state_;
    case State::release:
      builder_.set_current(std::max(-1.0, -2 * seconds()));
      return seconds() > 1.5 ? State::rise : state_;
    case State::rise:
      return builder_.lift_to(carrying + 0.02, 0.02) ? State::back_off : state_;
    case State::back_off:
      builder_.drive(-0.04, 0);
      return seconds() > 2.5 ? State::done : state_;
    default:
      builder_.stop();
      return State::done;
  }
}

}  // namespace
}  // namespace stacking

int main() try {
  ziggurat::Session session(ziggurat::Options::from_environment());
  stacking::Stacker stacker(session.robots().front());
  while (session.next()) {
    if (session.event() == ziggurat::Event::step) {
      stacker.step();
    } else {  // init or reset: tick 0
      stacker.restart();
    }
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "stacking: %s\n", error.what());
  return 1;
}
