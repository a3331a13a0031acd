// SPDX-License-Identifier: MIT
#pragma once
// All trees, stepped together. Islands of trees in contact are solved one by one, each from its own
// trees, contacts, servos and limits alone.

#include <memory>
#include <span>
#include <vector>

#include "physics/stepping/island_step.h"
#include "physics/stepping/sleeping.h"
#include "physics/stepping/team.h"

namespace ziggurat::dynamics {

/// Islands that a step left unchanged, because a link swings or nutates too fast for it, or because
/// it has an impact.
struct IslandsToSubdivide {
  struct Island {
    int parts = 0;                    ///< number of parts of the step; 0: it ends at the impact
    double impact_time = 0;           ///< of the first impact, from the step's beginning [s]
    std::size_t first = 0, last = 0;  ///< in `trees`
  };
  std::vector<Island> islands;
  std::vector<int> trees;  ///< ascending in each island

  void add(std::span<const int> of_island, int parts, double impact_time = 0);
};

/// Trees, and their predicted velocities at a substep's end.
struct PredictedVelocities {
  std::vector<int> trees;
  std::vector<double> velocities;  ///< of each dof of each tree, in their order
};

/// Exchanges the trees' velocities with the predicted ones.
void swap_velocities(std::vector<Tree>& trees, PredictedVelocities& prediction);

class System {
 public:
  std::vector<Tree> trees;
  SleepOptions sleeping;
  StepOptions options;
  IslandsToSubdivide islands_to_subdivide;  ///< by the last step()
  /// Trees whose rotation until impact is large: their islands are divided, because a contact acts
  /// along lines of the step's beginning. To be set before step().
  std::vector<RotationUntilImpact> rotations_until_impact;

  /// Whether a tree sleeps. Then a substep leaves it as it is, and ignores its contacts, until its
  /// island wakes: by an approaching contact, a change of its wrenches or servos, or wake().
  bool is_asleep(int tree) const { return sleep_.is_asleep(tree); }
  /// Grows when a tree falls asleep or wakes.
  std::uint64_t sleep_changes() const { return sleep_.changes; }
  /// Wakes a tree and its island: to be called when its pose, velocity or gravity was set, or a
  /// body that it touches was moved or removed.
  void wake(int tree) { dynamics::wake(sleep_, tree); }
  /// Wakes all trees; must be called when trees were removed or renumbered.
  void wake_all() { dynamics::wake_all(sleep_, trees.size()); }

  /// Adds to a link's external wrench for the coming substep. A sleeper ignores wrenches set
  /// otherwise.
  void apply_wrench(int tree, int link, const Wrench& wrench);

  /// Takes the constraints of the coming substep, see step(), and wakes the sleepers that they
  /// disturb. To be called before advance(), and again when contacts of sleepers were added.
  /// @return  whether a tree woke
  bool wake_disturbed(double time_step, std::span<ContactPoint> contacts, std::span<Servo> servos,
                      std::span<const int> chosen = {});

  /// Predicts velocities of trees that motors, wrenches or impacts accelerate within the coming
  /// substep: their present velocities do not tell their contacts. To be called after
  /// wake_disturbed(), whose contacts, servos and trees it takes.
  /// @param far   distance within the substep below which a change is ignored [m]
  /// @param fast  all trees that may come half as far already: impacts and limits may deflect them
  /// @return      whether there are some
  bool predict_velocities(std::span<Limit> limits, double far, std::span<const int> fast,
                          PredictedVelocities& out);

  /// Advances all trees that are awake by one substep. Their external wrenches must be set.
  /// @param time_step [s]
  /// The order of contacts in the list does not matter: in an island they are sorted by trees,
  /// links and places.
  /// @param contacts  those between two trees that stand on the world do nothing; impulses are
  ///                  read and written
  /// @param limits    of joints whose trees are awake
  /// @param chosen    trees that take part, ascending; the others stay as they are, and nothing may
  ///                  act between them and these. Empty: all do
  Report step(double time_step, std::span<ContactPoint> contacts, std::span<Servo> servos = {},
              std::span<Limit> limits = {}, std::span<const int> chosen = {});

  /// Advances by one substep with the constraints of wake_disturbed().
  /// @param watch  gets the times of solve and integrate; null: none
  Report advance(std::span<Limit> limits, timing::Stopwatch* watch = nullptr);

  /// Applies the impact law to touching contacts that approach: velocities change, positions stay.
  /// @param contacts, servos, limits  in: as in step(); servos with the bounds of what they may
  /// give at once; out: impulses
  void apply_impacts(std::span<ContactPoint> contacts, std::span<Servo> servos,
                     std::span<Limit> limits, std::span<const int> chosen);

  /// Resolves penetration without changing velocities: for overlaps that are found after a substep.
  /// @param contacts  of trees that are awake; their impulses do not matter
  /// @param chosen    as in step(): no others have contacts
  void separate(std::span<ContactPoint> contacts, std::span<const int> chosen = {});

  /// The solver, whose options hold for all threads.
  VelocitySolver& solver() { return memories_.front().solver; }

  /// Islands are stepped by a team of so many threads, with the same bits for any number. 1: by the
  /// caller's, as at first.
  /// @throws std::system_error if the system allows no more threads; then nothing changes
  void set_threads(unsigned threads);
  /// The team of set_threads(); null: one thread.
  Team* team() const { return team_.get(); }

  /// State of all trees and their sleep. Between two substeps, without wrenches.
  void archive(math::Archive& archive);

 private:
  void clear_wrenches();
  void find_islands();
  IslandStep island_step(std::size_t island, IslandMemory& memory, Report& report);
  void advance_island(std::size_t island, IslandMemory& memory, bool is_measured);
  struct IslandBlock;
  void advance_block(const IslandBlock& block, IslandMemory& memory, bool is_measured);
  void advance_islands(timing::Stopwatch* watch);
  void share_islands(bool is_measured);
  void subdivide(std::span<const int> island, const IslandOutcome& outcome);

  Sleep sleep_;
  // State of the step.
  double time_step_ = 0;
  ConstraintLists constraints_;
  std::span<const int> active_;
  std::vector<int> awake_;
  Islands islands_;
  std::vector<IslandMemory> memories_{1};  // of each thread
  /// An island that was advanced.
  struct AdvancedIsland {
    IslandOutcome outcome;
    Report report;
    bool ran_out_of_steps = false;
    bool is_quiet = false;
  };
  std::vector<AdvancedIsland> advanced_;  // of each island
  /// Islands that follow each other, which one thread takes.
  struct IslandBlock {
    std::size_t first = 0, last = 0;
    double cost = 0;
  };
  std::vector<IslandBlock> blocks_;
  timing::Stopwatch stages_;    // of the islands, in the last step in which they were measured
  unsigned steps_ = 0;          // with a watch
  std::shared_ptr<Team> team_;  // null: one thread
  // Memory of predict_velocities().
  std::vector<int> disturbed_;
  std::vector<unsigned char> is_fast_;  // of each tree: an impact may deflect it
};

}  // namespace ziggurat::dynamics
