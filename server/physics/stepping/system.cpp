// SPDX-License-Identifier: MIT
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
  if (active_.empty()) list_awake(sleep_, trees.size());
  for (const int tree : active_.empty() ? std::span<const int>(sleep_.awake) : active_) {
    if (trees[tree].dofs > 0 && !is_asleep(tree)) awake_.push_back(tree);
  }
  build_islands(trees, sleep_, awake_, constraints_, islands_);
}

IslandStep System::island_step(std::size_t island, IslandMemory& memory, Report& report) {
  sort_items(islands_, island, constraints_.contacts);
  return {trees,   islands_,   islands_[island], constraints_, rotations_until_impact,
          options, time_step_, memory,           report};
}

void System::set_threads(unsigned threads) {
  std::shared_ptr<Team> made = threads > 1 ? std::make_shared<Team>(threads) : nullptr;
  memories_.resize(std::max(1U, threads));
  team_ = std::move(made);
}

void System::apply_wrench(int tree, int link, const Wrench& wrench) {
  Wrench& external = trees[tree].external[link];
  external = external + wrench;
  if (sleep_.flags.size() < trees.size()) sleep_.flags.resize(trees.size(), 0);
  set_flag(sleep_, tree, Sleep::loaded);
}

/// Clears the wrenches of the active trees, but of those that the step left unchanged.
void System::clear_wrenches() {
  for_each_flagged(sleep_, active_, [&](int tree) {
    unsigned char& flags = sleep_.flags[tree];
    if (flags & Sleep::subdivided) {
      flags &= static_cast<unsigned char>(~Sleep::subdivided);
      return;
    }
    if (!(flags & Sleep::loaded)) return;
    flags &= static_cast<unsigned char>(~Sleep::loaded);
    std::ranges::fill(trees[tree].external, Wrench{});
  });
  std::erase_if(sleep_.flagged, [&](int tree) { return sleep_.flags[tree] == 0; });
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
  for (const int tree : island) set_flag(sleep_, tree, Sleep::subdivided);
  islands_to_subdivide.add(island, outcome.parts, outcome.impact_time);
}

/// Advances an island. It changes nothing of other islands.
void System::advance_island(std::size_t island, IslandMemory& memory, bool is_measured) {
  prefetch_after(islands_, island, trees, constraints_.contacts);
  AdvancedIsland& out = advanced_[island];
  out = {};
  IslandStep step = island_step(island, memory, out.report);
  if (is_measured) step.watch = &memory.watch;
  out.outcome = step_island(step);
  out.ran_out_of_steps = std::exchange(memory.work.ran_out_of_steps, false);
  out.is_quiet = out.outcome.is_carried &&
                 is_quiet(sleeping, trees, islands_[island].trees, out.outcome.heap_residual);
}

/// Advances islands that follow each other.
/// @param is_measured  whether the memory's watch gets the times of their stages
void System::advance_block(const IslandBlock& block, IslandMemory& memory, bool is_measured) {
  if (is_measured) memory.watch.start(timing::Phase::solve);
  for (std::size_t i = block.first; i < block.last; ++i) advance_island(i, memory, is_measured);
  if (is_measured) memory.watch.stop();
}

/// Shares the islands among the team's threads, in blocks of similar estimated cost.
void System::share_islands(bool is_measured) {
  constexpr double blocks_of_thread = 8;
  const auto cost_of = [&](std::size_t i) {
    const double size = static_cast<double>(islands_[i].trees.size());
    return size * size + static_cast<double>(islands_[i].items.size());
  };
  double all = 0;
  for (std::size_t i = 0; i < islands_.size(); ++i) all += cost_of(i);
  blocks_.clear();
  for (std::size_t i = 0; i < islands_.size(); ++i) {
    if (blocks_.empty() || blocks_.back().cost * blocks_of_thread * team_->size() >= all)
      blocks_.push_back({i, i, 0});
    blocks_.back().last = i + 1;
    blocks_.back().cost += cost_of(i);
  }
  for (IslandMemory& memory : memories_) memory.solver.options = solver().options;
  team_->share(blocks_.size(), [&](std::size_t block, unsigned member) {
    advance_block(blocks_[block], memories_[member], is_measured);
  });
}

/// Advances all islands. Their time is divided among their stages as in the last step in which
/// these were measured: that is not each step, because an island may take no longer than to read a
/// clock.
/// @param watch  of the present stage; null: nothing is measured
void System::advance_islands(timing::Stopwatch* watch) {
  constexpr std::size_t few = 64;           // constraints that are not worth waking a thread
  constexpr unsigned steps_per_sample = 7;  // divides no usual number of substeps
  const bool is_measured = watch && steps_++ % steps_per_sample == 0;
  advanced_.resize(islands_.size());
  if (team_ && islands_.size() > 1 && islands_.items.size() >= few) {
    share_islands(is_measured);
  } else {
    advance_block({0, islands_.size(), 0}, memories_.front(), is_measured);
  }
  if (is_measured) {
    stages_ = timing::Stopwatch();
    for (IslandMemory& memory : memories_) stages_.add(memory.watch);
  }
  if (watch) watch->divide_like(stages_);
}

Report System::advance(std::span<Limit> limits, timing::Stopwatch* watch) {
  enter(watch, timing::Phase::solve);
  constraints_.limits = limits;
  Report report;
  islands_to_subdivide.islands.clear();
  islands_to_subdivide.trees.clear();
  find_islands();
  report.awake = static_cast<int>(awake_.size());
  advance_islands(watch);
  enter(watch, timing::Phase::integrate);
  for (std::size_t i = 0; i < islands_.size(); ++i) {
    const AdvancedIsland& island = advanced_[i];
    add(island.report, report);
    if (island.outcome.is_left()) {
      subdivide(islands_[i].trees, island.outcome);
    } else {
      update_sleep(sleep_, sleeping, trees, islands_[i].trees, time_step_, island.is_quiet,
                   island.outcome.heap_residual);
    }
    if (!island.ran_out_of_steps) continue;
    ++report.not_converged;
    report.islands = std::max(report.islands, report.not_converged);
  }
  clear_wrenches();
  active_ = {};
  return report;
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
  Report report;
  for (std::size_t i = 0; i < islands_.size(); ++i) {
    if (islands_[i].has_contact())
      dynamics::apply_impacts(island_step(i, memories_.front(), report));
  }
  active_ = {};
}

void System::separate(std::span<ContactPoint> contacts, std::span<const int> chosen) {
  constraints_.contacts = contacts;
  list_contact_trees(contacts, constraints_.contact_trees);
  constraints_.servos = {};
  active_ = chosen;
  find_islands();
  Report report;
  for (std::size_t i = 0; i < islands_.size(); ++i) {
    if (islands_[i].has_contact()) dynamics::separate(island_step(i, memories_.front(), report));
  }
  active_ = {};
}

}  // namespace ziggurat::dynamics
