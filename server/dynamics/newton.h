#pragma once
// Solves the velocity problem of an island, by the first of these that converges:
// - Newton's method on the contact law (semi-smooth, as in Alart and Curnier 1991; S. Hueeber and
//   B. Wohlmuth, Comput. Methods Appl. Mech. Eng. 194, 2005), for small islands;
// - Newton's method on the softened problem about the last impulses (the method of multipliers, R. T.
//   Rockafellar, Math. Oper. Res. 1, 1976): of larger islands for what rests, of small ones with a
//   line search, from where everything is soft, or after sweeps;
// - the interior point method, for larger islands that strike;
// - sweeps over the contacts alone, where a factorisation costs too much.
// All but the last factor one matrix along the contact graph.

#include <algorithm>

#include "dynamics/block_matrix.h"
#include "dynamics/contact_law.h"
#include "dynamics/gauss_seidel.h"

namespace ziggurat::dynamics {

/// How an island was solved.
struct Outcome {
  int iterations = 0;  ///< of Newton's method
  int descents = 0;    ///< steps of the softened problem
  int interior = 0;    ///< steps of the interior point method
  int sweeps = 0;      ///< over all contacts
  double miss = 0;     ///< worst violation of the contact law that is left [m/s] or [rad/s]
  bool converged = true;
};

/// How fast an island is before it is solved.
struct Beginning {
  double fastest = 0;  ///< of its contacts [m/s]
  double fall = 0;     ///< what gravity gives in a substep [m/s]
  /// Whether a contact is faster than forces of one substep make it.
  bool strikes() const { return fastest > fall; }
};

struct SolverOptions {
  double newton_work = 3e4;  ///< multiplications of a factorisation; more: not on the law itself
  std::size_t few_trees = 8;  ///< make no heap, however large they are:
  double more_for_few = 50;   ///< times as many multiplications for them
  int most_iterations = 16;  ///< of Newton's method on the law itself
  double near = 1e-3;        ///< a miss of this times the largest speed needs no new factors
  int most_far = 6;          ///< iterations that lead no nearer, with a miss above `far`
  double far = 1e-3;         ///< times the largest speed
  int most_descents = 8;     ///< full steps of the softened problem
  double softness = 1e-3;    ///< its impulses give way by this times the mobility
  int most_interior = 40;    ///< steps of the interior point method
  double most_work = 1.2e7;  ///< multiplications of a factorisation; more: sweeps
  std::size_t most_trees = 300;       ///< of an island whose matrix is looked at
  int most_sweeps = 60;               ///< of islands that are not factored
  int first_sweeps = 20;              ///< before patient steps
  int most_patient = 60;              ///< steps of the softened problem with a line search
  int displacement_sweeps = 20;       ///< of a displacement that Newton's method does not find
  double displacement_miss = 1e-5;    ///< [m], [rad] of it; more: the softened problem
  double rounding = 1e-7;             ///< of it, where Newton's method leads no nearer
  double relative_tolerance = 1e-9;   ///< of the largest speed or speed change in the island
  double still_tolerance = 1e-8;      ///< of it, for the momentum that the last substep's solution misses
  double soft_tolerance = 2e-5;       ///< of it, where Newton's method did not converge
  double most_scale = 4;             ///< of that speed, over the speeds at the beginning: redundant contacts may hold each other up with any impulse
  double absolute_tolerance = 1e-10;  ///< [m/s] or [rad/s]

  bool suits_newton(std::size_t trees, double work) const {
    return work <= newton_work * (trees <= few_trees ? more_for_few : 1);
  }
  double tolerance_of_softened(const Beginning& beginning, double scale) const {
    const double least = std::max(beginning.fastest, beginning.fall);
    return absolute_tolerance + soft_tolerance * (least > 0 ? std::min(scale, most_scale * least) : scale);
  }
  double tolerance(double scale) const { return absolute_tolerance + relative_tolerance * scale; }
};

/// A block in the interior point method: impulse and speed in units in which a contact's cone is
/// x_0 >= |(x_1, x_2)|, and what belongs to its present step.
struct InteriorBlock {
  Vector3 impulse{0, 0, 0}, speed{0, 0, 0}, anchor{0, 0, 0};
  Vector3 unit{0, 0, 0};              ///< impulses of the block over those here
  Vector3 give{0, 0, 0};              ///< speed over impulse
  double lower = 0, upper = 0;        ///< of blocks that are not cones
  double at_lower = 0, at_upper = 0;  ///< their speeds beyond the one sought; 0: without bound
  Matrix3 scaling = Matrix3::Zero(), unscaling = Matrix3::Zero(), slope = Matrix3::Zero();
  Vector3 point{0, 0, 0}, lift{0, 0, 0}, residual{0, 0, 0}, aim{0, 0, 0}, constant{0, 0, 0};
  Vector3 change{0, 0, 0}, speed_change{0, 0, 0};
  double lower_change = 0, upper_change = 0;
};

/// out += J^T impulse of a block.
void add_impulse(const Problem& problem, const Block& block, const double* impulse,
                 std::vector<double>& out);
/// out := p + J^T g - M v, with the joints' damping in M.
/// @return  the largest change of a coordinate's speed that is missing, about [m/s] or [rad/s]
double imbalance(const Problem& problem, std::vector<double>& out);
/// Whether of each coordinate little is missing beside its own impulses.
/// @param missing  see imbalance();  @param share  of its impulses;  @param least  what never counts [m/s] or [rad/s]
/// @param given    memory
bool is_balanced(const Problem& problem, std::span<const double> missing, double share, double least, std::vector<double>& given);

/// The mass matrices of a problem, with the joints' damping.
/// @param matrix  of its shape
void start_matrix(const Problem& problem, BlockMatrix& matrix);

/// Velocities and impulses of a problem.
struct Snapshot {
  std::vector<double> velocity;                                ///< of each dof
  std::vector<std::array<double, Block::most_rows>> impulses;  ///< of each block
  void take(const Problem& problem);
  void give_back(Problem& problem) const;
  /// Takes velocities and impulses back by a share of the way.
  void draw_back(Problem& problem, double share) const;
};

class Solver {
 public:
  SolverOptions options;

  /// Solves for problem.velocity and the blocks' impulses, from what they are.
  Outcome solve(Problem& problem);
  /// The solution if nothing rebounded, of a problem that is solved; leaves that as it is.
  void solve_without_rebound(Problem& problem, Snapshot& out);
  /// Solves a displacement, which need not be exact where hundreds of bodies overlap.
  void solve_displacement(Problem& problem);

 private:
  bool iterate(Problem& problem, Outcome& outcome, int most_far);
  bool step(Problem& problem);
  void shorten(Problem& problem, double& wrong);
  void correct(Problem& problem);
  bool correct_while_nearer(Problem& problem, Outcome& outcome);
  double start(Problem& problem);
  bool still_solved(const Problem& problem, Outcome& outcome);
  void take_speeds(const Problem& problem);
  double miss_now(const Problem& problem, double& scale) const;
  bool proximal(Problem& problem, Outcome& outcome);
  void ease(Problem& problem, Outcome& outcome);
  bool patient_proximal(Problem& problem, Outcome& outcome);
  bool proximal_step(Problem& problem, double softness, bool anchors, double shortest, double& unbalanced);
  bool interior_points(Problem& problem, Outcome& outcome);
  void enter(const Problem& problem, double margin);
  double linearise_interior(Problem& problem);
  double interior_direction(Problem& problem, double target, bool corrects);
  double product_after(const Problem& problem, double way) const;
  void advance_interior(Problem& problem, double way);
  bool sweep_until_converged(Problem& problem, Outcome& outcome, int most);
  bool soften_after_sweeps(Problem& problem, Outcome& outcome);
  void sharpen(Problem& problem, Outcome& outcome);

  BlockMatrix matrix_;
  std::vector<std::array<double, Block::most_rows>> speeds_;  // of each block, by take_speeds()
  std::vector<std::array<double, Block::most_rows>> kept_speeds_;
  std::vector<Linear> linear_;
  Linear now_;
  std::vector<int> sizes_;
  std::vector<double> sloped_;
  std::vector<double> kept_velocity_, anchored_;
  Beginning beginning_;
  Snapshot start_, snapshot_, rebounding_, earlier_;
  std::vector<double> seeks_;
  std::vector<double> direction_, residual_, given_;
  std::vector<InteriorBlock> interior_;
  Sweeps sweeps_;
};

}  // namespace ziggurat::dynamics
