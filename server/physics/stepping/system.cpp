#include "physics/stepping/system.h"

#include <algorithm>
#include <utility>

namespace ziggurat::dynamics {

void IslandsToSubdivide::add(std::span<const int> of_island, int parts, double impact_time) {
  islands.push_back({parts, impact_time, trees.size(), trees.size() + of_island.size()});
  trees.insert(trees.end(), of_island.begin(), of_island.end());
}

/// Lists the active trees that are awake, and sorts them and their constraints by island.
void System::find_islands() {
  awake_.clear();
  for_each_active(active_, trees.size(), [&](int tree) {
    if (trees[tree].dofs > 0 && !is_asleep(tree)) awake_.push_back(tree);
  });
  build_islands(trees, sleep_, awake_, constraints_, islands_);
}

IslandStep System::island_step(std::size_t island) {
  return {trees,   islands_,   islands_[island], constraints_, rotations_until_impact,
          options, time_step_, memory_,          report_};
}

void System::apply_wrench(int tree, int link, const Wrench& wrench) {
  Wrench& external = trees[tree].external[link];
  external = external + wrench;
  if (sleep_.flags.size() < trees.size()) sleep_.flags.resize(trees.size(), 0);
  sleep_.flags[tree] |= Sleep::loaded;
}

/// Clears the wrenches of the active trees, but of those that the step left unchanged.
void System::clear_wrenches() {
  for_each_active(active_, trees.size(), [&](int tree) {
    unsigned char& flags = sleep_.flags[tree];
    if (flags & Sleep::subdivided) {
      flags &= static_cast<unsigned char>(~Sleep::subdivided);
      return;
    }
    if (!(flags & Sleep::loaded)) return;
    flags &= static_cast<unsigned char>(~Sleep::loaded);
    std::ranges::fill(trees[tree].external, Wrench{});
  });
}

bool System::wake_disturbed(double time_step, std::span<ContactPoint> contacts,
                            std::span<Servo> servos, std::span<const int> chosen) {
  time_step_ = time_step;
  active_ = chosen;
  constraints_.servos = servos;
  constraints_.contacts = contacts;
  list_contact_trees(contacts, constraints_.contact_trees);
  return dynamics::wake_disturbed(sleep_, trees, active_, constraints_, time_step);
}

Report System::step(double time_step, std::span<ContactPoint> contacts, std::span<Servo> servos,
                    std::span<Limit> limits, std::span<const int> chosen) {
  wake_disturbed(time_step, contacts, servos, chosen);
  return advance(limits);
}

/// Leaves an island unchanged, to be stepped in parts.
void System::subdivide(std::span<const int> island, const IslandOutcome& outcome) {
  for (const int tree : island) sleep_.flags[tree] |= Sleep::subdivided;
  islands_to_subdivide.add(island, outcome.parts, outcome.impact_time);
}

Report System::advance(std::span<Limit> limits) {
  constraints_.limits = limits;
  report_ = {};
  islands_to_subdivide.islands.clear();
  islands_to_subdivide.trees.clear();
  find_islands();
  report_.awake = static_cast<int>(awake_.size());
  for (std::size_t i = 0; i < islands_.size(); ++i) {
    prefetch_after(islands_, i, trees, constraints_.contacts);
    const IslandOutcome outcome = step_island(island_step(i));
    if (outcome.is_left()) {
      subdivide(islands_[i].trees, outcome);
    } else {
      update_sleep(sleep_, sleeping, trees, islands_[i].trees, time_step_, outcome.is_carried,
                   outcome.heap_residual);
    }
    if (!std::exchange(memory_.work.ran_out_of_steps, false)) continue;
    ++report_.not_converged;
    report_.islands = std::max(report_.islands, report_.not_converged);
  }
  clear_wrenches();
  active_ = {};
  return report_;
}

void System::apply_impacts(std::span<ContactPoint> contacts, std::span<Servo> servos,
                           std::span<Limit> limits, std::span<const int> chosen) {
  constexpr double instant = 1e-14;  // in which neither forces nor damping change a velocity [s]
  constraints_.contacts = contacts;
  list_contact_trees(contacts, constraints_.contact_trees);
  constraints_.servos = servos;
  constraints_.limits = limits;
  active_ = chosen;
  time_step_ = instant;
  find_islands();
  for (std::size_t i = 0; i < islands_.size(); ++i) {
    if (islands_[i].has_contact()) dynamics::apply_impacts(island_step(i));
  }
  active_ = {};
}

void System::separate(std::span<ContactPoint> contacts, std::span<const int> chosen) {
  constraints_.contacts = contacts;
  list_contact_trees(contacts, constraints_.contact_trees);
  constraints_.servos = {};
  active_ = chosen;
  find_islands();
  for (std::size_t i = 0; i < islands_.size(); ++i) {
    if (islands_[i].has_contact()) dynamics::separate(island_step(i));
  }
  active_ = {};
}

}  // namespace ziggurat::dynamics
