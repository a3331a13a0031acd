// SPDX-License-Identifier: MIT
// The states in which a robot begins. One that was started again in the middle of its work knows
// nothing but what it senses: the lift's height, whether it holds a block, and what that block
// says.

#include <algorithm>
#include <cmath>

#include "assembler.h"

namespace assembly {

Next start(Assembler& self, Faces /*faces*/) {
  if (self.first_tick > 0) return State::sense;
  self.builder.set_current(-1);
  if (self.builder.lift_to(clearance, 0.05)) return State::scan;
  return {};
}

namespace {

/// State that the held block remembers of the robot.
Next recall(Assembler& self, ziggurat::Bytes message) {
  const double height = self.builder.lift_height();
  if (message.empty()) return {};
  if (message[0] == 2) {  // the block has been placed, and told so
    self.job.place = {};
    self.job.place.row.above = height > 0.03;
    self.job.place.row.height = static_cast<int>(std::floor(height / construction::block + 0.5));
    return State::release;
  }
  if (message[0] != 4 || message.size() < 2) return {};
  self.job.payload = message[1];
  self.builder.loaded = true;
  self.builder.set_current(0);
  const Row* row = message.size() < 3 ? nullptr : self.plan.row_of(message[2]);
  if (!row) return State::withdraw;
  self.job.place = {};  // it was being placed
  self.job.place.row = *row;
  return State::place;
}

}  // namespace

// Nothing moves until it is clear what the robot was at. It may stand at the structure: others stay
// away.
Next sense(Assembler& self, Faces /*faces*/) {
  self.builder.stop();
  self.traffic.holding = true;
  if (!self.builder.holds()) return State::withdraw;
  for (const ziggurat::Bytes message : self.builder.received()) {
    if (const Next next = recall(self, message)) return next;
  }
  if (self.job.seconds() > 3) return State::withdraw;  // it was just being picked up
  return {};
}

// Up, off what is below, and straight back from what is ahead.
Next withdraw(Assembler& self, Faces /*faces*/) {
  construction::Builder& builder = self.builder;
  Job& job = self.job;
  if (!builder.loaded) builder.set_current(-1);
  if (job.seconds() <= construction::tick) {
    const double height = builder.lift_height();
    const double free = std::min(highest_lift, builder.below() < 0.04 ? height + 0.03 : height);
    job.withdraw_to = std::max(height, builder.loaded ? carrying : free);
    job.back.reset();
  }
  if (!builder.lift_to(job.withdraw_to, 0.03)) return {};
  if (!job.back) job.back = builder.ahead() < 0.3 ? 35 : 0;
  if (*job.back > 0 && !is_blocked(self.traffic, -1)) {
    --*job.back;
    builder.drive(-0.05, 0);
    return {};
  }
  builder.stop();
  if (*job.back > 0 && job.seconds() < 20) return {};
  leave_structure(self.traffic);
  return State::scan;
}

}  // namespace assembly
