#pragma once
// All trees, stepped together: islands of trees that touch are solved one by one, each from its own
// trees, contacts, servos and limits alone.

#include <cstdint>
#include <span>
#include <vector>

#include "dynamics/newton.h"

namespace ziggurat::dynamics {

/// What became of a substep.
struct Report {
  int islands = 0;         ///< solved for contacts, servos or limits
  int not_converged = 0;   ///< of them
  int most_iterations = 0; ///< of Newton's method in an island
  int most_descents = 0;   ///< of the softened problem
  int most_interior = 0;   ///< of the interior point method
  int most_sweeps = 0;     ///< over the contacts of an island
  double miss = 0;         ///< worst violation of the contact law [m/s] or [rad/s]
};

class System {
 public:
  std::vector<Tree> trees;

  /// Advances all trees that are awake by one substep. Their external wrenches must be set.
  /// @param length    [s]
  /// The order of contacts in the list does not matter: in an island they are sorted by trees, links
  /// and places.
  /// @param contacts  those between two trees that stand on the world do nothing; impulses are
  ///                  read and written
  /// @param limits    of joints whose trees are awake
  Report step(double length, std::span<Contact> contacts, std::span<Servo> servos = {},
              std::span<Limit> limits = {});

  Solver& solver() { return solver_; }

 private:
  struct Item {
    int island;
    int kind;  // contact, servo, limit
    int index;
  };
  int find(int tree);
  bool before(const Item& a, const Item& b) const;
  void gather(std::span<const Contact> contacts, std::span<const Servo> servos,
              std::span<const Limit> limits);
  void solve_island(int first_tree, int last_tree, int first_item, int last_item);
  bool fly_island(int first_tree, int last_tree, int first_item, int last_item);
  void add(const Outcome& outcome);  // to the report
  void write_impulses();

  double length_ = 0;
  std::span<Contact> contacts_;
  std::span<Servo> servos_;
  std::span<Limit> limits_;
  Report report_;

  std::vector<int> parent_, island_, place_;
  std::vector<int> first_tree_, tree_order_, first_item_;
  std::vector<Item> items_, item_order_;
  std::vector<double> kept_, step_;
  Problem problem_;
  Solver solver_;
};

}  // namespace ziggurat::dynamics
