#include "math/archive.h"

#include <algorithm>

#include "dynamics/system.h"

namespace ziggurat::dynamics {

void Tree::archive(math::Archive& archive) {
  archive("q", q);
  archive.require(has_rotations(), "has a turn that is no rotation");
  archive("v", v);
  archive("flight_step", flight_step);
  for (Wrench& wrench : held_by) {
    archive("held_by_moment", wrench.moment);
    archive("held_by_force", wrench.force);
  }
  if (links[0].joint == JointType::fixed) archive("root", fixed_root_);
  if (!archive.reads()) return;
  place(*this);
  dynamics::move(*this);
  std::fill(external.begin(), external.end(), Wrench{});
}

void System::Sleeper::archive(math::Archive& archive) {
  archive("quiet", quiet);
  archive("command", command);
  archive("command_asleep", command_asleep);
  archive("force_bound", force_bound);
}

void System::archive(math::Archive& archive) {
  archive("trees", trees);
  archive.list("sleepers", sleepers_);
  archive.list("next", next_);
  archive.list("watch", watch_);
  const bool is_right =
      sleepers_.size() <= trees.size() && next_.size() == sleepers_.size() &&
      watch_.size() <= trees.size() && std::ranges::all_of(next_, [&](int next) {
        return next >= -1 && next < static_cast<int>(next_.size());
      });
  if (!is_right) wake_all();
  archive.require(is_right, "knows sleepers that are no trees");
}

}  // namespace ziggurat::dynamics
