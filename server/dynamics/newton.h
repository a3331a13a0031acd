#pragma once
// Solves the velocity problem of an island: Newton's method on the contact law (semi-smooth, as in
// Alart and Curnier 1991; S. Hueeber and B. Wohlmuth, Comput. Methods Appl. Mech. Eng. 194, 2005),
// with a direct factorisation along the contact graph; where that costs too much or does not
// converge, sweeps over the contacts.

#include "dynamics/block_matrix.h"
#include "dynamics/law.h"

namespace ziggurat::dynamics {

/// How an island was solved.
struct Outcome {
  int iterations = 0;   ///< of Newton's method
  int sweeps = 0;
  double miss = 0;      ///< worst violation of the contact law that is left [m/s] or [rad/s]
  bool converged = true;
};

struct SolverOptions {
  int most_iterations = 40;
  int most_sweeps = 60;
  double relative_tolerance = 1e-8;  ///< of the largest speed or speed change in the island
  double absolute_tolerance = 1e-10; ///< [m/s] or [rad/s]
  double most_work = 4e6;            ///< multiplications of a factorisation; more: sweeps
};

class Solver {
 public:
  SolverOptions options;

  /// Solves for problem.velocity and the blocks' impulses, from what they are.
  Outcome solve(Problem& problem);

 private:
  bool at_rest(const Problem& problem);
  bool step(Problem& problem, bool coupled);
  void add_block(Problem& problem, const Block& block, const Linear& linear);
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
  std::vector<double> kept_velocity_, kept_impulses_;
  // Of the sweeps.
  std::vector<double> response_;  // M^-1 J^T, as the Jacobian
  std::vector<double> diagonal_;  // per block and row: J M^-1 J^T
};

}  // namespace ziggurat::dynamics
