#pragma once
// Solves the velocity problem of an island.
// - Newton's method on the contact law (semi-smooth, as in Alart and Curnier 1991; S. Hueeber and
//   B. Wohlmuth, Comput. Methods Appl. Mech. Eng. 194, 2005), factored along the contact graph.
// - Where it does not converge: softened problems, each anchored at the impulses of the one before
//   (the method of multipliers, R. T. Rockafellar, Math. Oper. Res. 1, 1976).
// - Where a factorisation costs too much: sweeps over the contacts.

#include "dynamics/block_matrix.h"
#include "dynamics/law.h"

namespace ziggurat::dynamics {

/// How an island was solved.
struct Outcome {
  int iterations = 0;   ///< of Newton's method
  int descents = 0;     ///< steps of softened problems, where Newton's method failed
  int sweeps = 0;       ///< over all contacts
  double miss = 0;      ///< worst violation of the contact law that is left [m/s] or [rad/s]
  bool converged = true;
};

struct SolverOptions {
  int most_iterations = 16;  ///< of Newton's method on the law itself
  int most_anchors = 20;     ///< softened problems
  int few_anchors = 6;       ///< of them, before soft_tolerance is enough
  int most_descents = 30;    ///< steps of each with given bounds of friction
  int most_coupled = 8;      ///< steps of each with bounds that follow the normal impulses
  double softness = 1e-3;    ///< impulses give way by this times the mobility
  int most_sweeps = 60;      ///< of large islands
  double relative_tolerance = 1e-7;  ///< of the largest speed or speed change in the island
  double soft_tolerance = 2e-5;      ///< of it, where Newton's method did not converge
  double absolute_tolerance = 1e-10; ///< [m/s] or [rad/s]
  double most_work = 4e6;            ///< multiplications of a factorisation; more: sweeps
};

class Solver {
 public:
  SolverOptions options;

  /// Solves for problem.velocity and the blocks' impulses, from what they are.
  Outcome solve(Problem& problem);

 private:
  struct Snapshot {
    std::vector<double> velocity;
    std::vector<std::array<double, Block::most_rows>> impulses;
    void take(const Problem& problem);
    void give_back(Problem& problem) const;
  };
  void start_matrix(Problem& problem);
  bool descend(Problem& problem, bool coupled, double& largest);
  bool relax(Problem& problem, Outcome& outcome, bool coupled, double enough);
  double line_search(Problem& problem, const std::vector<double>& direction);
  bool iterate(Problem& problem, Outcome& outcome, int most);
  bool step(Problem& problem);
  void soften_until_converged(Problem& problem, Outcome& outcome);
  void add_slope(const Problem& problem, const Block& block, const Linear& linear);
  void add_constant(Problem& problem, const Block& block, const Linear& linear);
  double worst_miss(const Problem& problem, double& scale) const;
  void sweep_until_converged(Problem& problem, Outcome& outcome, int most);
  void prepare_sweeps(Problem& problem);
  void sweep_block(Problem& problem, Block& block, std::size_t index);
  double tolerance(double scale) const {
    return options.absolute_tolerance + options.relative_tolerance * scale;
  }

  BlockMatrix matrix_;
  std::vector<Linear> linear_;
  std::vector<int> sizes_;
  std::vector<double> sloped_;
  std::vector<double> kept_velocity_;
  Snapshot snapshot_;
  // Of descents.
  std::vector<double> direction_, gradient_, speeds_, changes_;
  // Of the sweeps.
  std::vector<double> response_;  // M^-1 J^T, as the Jacobian
  std::vector<double> diagonal_;  // per block and row: J M^-1 J^T
};

}  // namespace ziggurat::dynamics
