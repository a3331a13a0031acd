#include "math/archive.h"

#include <algorithm>

#include "dynamics/system.h"

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

void System::SleepState::archive(math::Archive& archive) {
  archive("quiet", time_at_rest);
  archive("command", command);
  archive("command_asleep", command_asleep);
  archive("force_bound", force_bound);
}

void System::archive(math::Archive& archive) {
  archive("trees", trees);
  archive.list("sleepers", sleep_states_);
  archive.list("next", sleep_ring_);
  archive.list("watch", wake_flags_);
  const bool is_right =
      sleep_states_.size() <= trees.size() && sleep_ring_.size() == sleep_states_.size() &&
      wake_flags_.size() <= trees.size() && std::ranges::all_of(sleep_ring_, [&](int next) {
        return next >= -1 && next < static_cast<int>(sleep_ring_.size());
      });
  if (!is_right) wake_all();
  archive.require(is_right, "knows sleepers that are no trees");
}

}  // namespace ziggurat::dynamics
