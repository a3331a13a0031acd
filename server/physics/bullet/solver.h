#pragma once
// Bullet's multi-body constraint solver with Coulomb friction that points against the slip.
//
// Bullet clips each contact's two friction impulses to the cone along the direction of what either
// row alone would need. A wheel is light along its rolling direction and carries the whole robot
// across it. So that direction is far from the slip's, and skidding robots turn at a sixth of the
// right rate. Here the clipped impulse turns towards the slip itself.

#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>

namespace ziggurat::physics {

class Solver final : public btMultiBodyConstraintSolver {
 public:
  /// @param sweeps_per_body  limits the sweeps of an island of single bodies to so many for each
  ///                         of them: a lone box settles with few, a tower needs more; islands
  ///                         with a robot always get btContactSolverInfo::m_numIterations
  explicit Solver(int sweeps_per_body) : sweeps_per_body_(sweeps_per_body) {}

 protected:
  btScalar solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                btPersistentManifold** manifolds, int manifold_count,
                                btTypedConstraint** constraints, int constraint_count,
                                const btContactSolverInfo& info, btIDebugDraw* draw) override;

 private:
  using Row = btMultiBodySolverConstraint;

  btScalar speed_change(const Row& row) const;
  void apply(const Row& row, btScalar impulse);
  void warm_start();
  btScalar solve_row(const Row& row);
  btScalar solve_friction(const Row& first, const Row& second, btScalar limit);
  btScalar solve_friction(btMultiBodyConstraintArray& rows);

  int sweeps_per_body_;
};

}  // namespace ziggurat::physics
