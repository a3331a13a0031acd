// SPDX-License-Identifier: MIT
#include "math/archive.h"

#include <algorithm>

#include "physics/stepping/system.h"

namespace ziggurat::dynamics {

void Tree::archive(math::Archive& archive) {
  archive("q", q);
  archive.require(has_rotations(), "has a turn that is no rotation");
  archive("v", v);
  archive("flight_step", integrator_step);
  for (Wrench& wrench : external_at_sleep) {
    archive("held_by_moment", wrench.moment);
    archive("held_by_force", wrench.force);
  }
  if (links[0].joint == JointType::fixed) archive("root", fixed_root_);
  if (!archive.reads()) return;
  forward_kinematics(*this);
  dynamics::velocity_kinematics(*this);
  std::fill(external.begin(), external.end(), Wrench{});
}

void SleepState::archive(math::Archive& archive) {
  archive("quiet", time_at_rest);
  archive("command", command);
  archive("command_asleep", command_asleep);
  archive("force_bound", force_bound);
}

void System::archive(math::Archive& archive) {
  archive("trees", trees);
  archive.list("sleepers", sleep_.states);
  archive.list("next", sleep_.ring);
  archive.list("watch", sleep_.flags);
  const bool is_right =
      sleep_.states.size() <= trees.size() && sleep_.ring.size() == sleep_.states.size() &&
      sleep_.flags.size() <= trees.size() && std::ranges::all_of(sleep_.ring, [&](int next) {
        return next >= -1 && next < static_cast<int>(sleep_.ring.size());
      });
  if (!is_right) wake_all();
  ++sleep_.changes;
  list_flagged(sleep_);
  archive.require(is_right, "knows sleepers that are no trees");
}

}  // namespace ziggurat::dynamics
