#include "physics/bullet/solver.h"

#include <algorithm>

namespace ziggurat::physics {
namespace {

// More makes rows overshoot and stacks tremble; less wastes sweeps.
constexpr btScalar warm_start_share = 0.3;

/// In four sums at once: one would be a chain of additions that wait for each other.
inline btScalar dot(const btScalar* a, const btScalar* b, int count) {
  btScalar sum0 = 0, sum1 = 0, sum2 = 0, sum3 = 0;
  int i = 0;
  for (; i + 4 <= count; i += 4) {
    sum0 += a[i] * b[i];
    sum1 += a[i + 1] * b[i + 1];
    sum2 += a[i + 2] * b[i + 2];
    sum3 += a[i + 3] * b[i + 3];
  }
  btScalar even = sum0 + sum2, odd = sum1 + sum3;
  if (i + 2 <= count) {
    even += a[i] * b[i];
    odd += a[i + 1] * b[i + 1];
    i += 2;
  }
  return i < count ? even + odd + a[i] * b[i] : even + odd;
}

}  // namespace

// The impulses of this step change a multi-body's velocities in its own vector, which Bullet adds
// to them at the end. Bullet's second copy of it, m_deltaVelocities, is not updated: it is never
// read.

/// Change of the row's relative velocity by the impulses of this step.
btScalar Solver::speed_change(const Row& row) const {
  btScalar speed = 0;
  const auto add_multi = [&](const btMultiBody& body, int jacobian_index) {
    speed += dot(&m_data.m_jacobians[jacobian_index], body.getDeltaVelocityVector(),
                 body.getNumDofs() + 6);
  };
  const auto add_rigid = [&](int id, const btVector3& normal, const btVector3& arm_normal) {
    const btSolverBody& body = m_tmpSolverBodyPool[id];
    if (!body.m_originalBody) return;  // fixed
    speed += normal.dot(body.m_deltaLinearVelocity) + arm_normal.dot(body.m_deltaAngularVelocity);
  };
  if (row.m_multiBodyA) {
    add_multi(*row.m_multiBodyA, row.m_jacAindex);
  } else if (row.m_solverBodyIdA >= 0) {
    add_rigid(row.m_solverBodyIdA, row.m_contactNormal1, row.m_relpos1CrossNormal);
  }
  if (row.m_multiBodyB) {
    add_multi(*row.m_multiBodyB, row.m_jacBindex);
  } else if (row.m_solverBodyIdB >= 0) {
    add_rigid(row.m_solverBodyIdB, row.m_contactNormal2, row.m_relpos2CrossNormal);
  }
  return speed;
}

void Solver::apply(const Row& row, btScalar impulse) {
  if (impulse == 0) return;
  row.m_appliedImpulse += impulse;
  if (row.m_multiBodyA) {
    row.m_multiBodyA->applyDeltaVeeMultiDof2(&m_data.m_deltaVelocitiesUnitImpulse[row.m_jacAindex],
                                             impulse);
  } else if (row.m_solverBodyIdA >= 0) {
    btSolverBody& body = m_tmpSolverBodyPool[row.m_solverBodyIdA];
    body.internalApplyImpulse(row.m_contactNormal1 * body.internalGetInvMass(),
                              row.m_angularComponentA, impulse);
  }
  if (row.m_multiBodyB) {
    row.m_multiBodyB->applyDeltaVeeMultiDof2(&m_data.m_deltaVelocitiesUnitImpulse[row.m_jacBindex],
                                             impulse);
  } else if (row.m_solverBodyIdB >= 0) {
    btSolverBody& body = m_tmpSolverBodyPool[row.m_solverBodyIdB];
    body.internalApplyImpulse(row.m_contactNormal2 * body.internalGetInvMass(),
                              row.m_angularComponentB, impulse);
  }
}

/// @return by how much the row's velocity changed
btScalar Solver::solve_row(const Row& row) {
  if (row.m_jacDiagABInv == 0) return 0;
  const btScalar wanted =
      row.m_rhs - row.m_appliedImpulse * row.m_cfm - speed_change(row) * row.m_jacDiagABInv;
  const btScalar impulse =
      std::clamp(row.m_appliedImpulse + wanted, row.m_lowerLimit, row.m_upperLimit) -
      row.m_appliedImpulse;
  apply(row, impulse);
  return impulse / row.m_jacDiagABInv;
}

btScalar Solver::solve_friction(const Row& first, const Row& second, btScalar limit) {
  if (first.m_jacDiagABInv == 0 || second.m_jacDiagABInv == 0) return 0;
  const btScalar wanted_first = first.m_rhs - speed_change(first) * first.m_jacDiagABInv;
  const btScalar wanted_second = second.m_rhs - speed_change(second) * second.m_jacDiagABInv;
  btScalar to_first = first.m_appliedImpulse + wanted_first;
  btScalar to_second = second.m_appliedImpulse + wanted_second;
  if (to_first * to_first + to_second * to_second > limit * limit) {
    // Sliding: step along the slip (both rows scaled alike), then back onto the cone.
    const btScalar step = btMin(first.m_jacDiagABInv, second.m_jacDiagABInv);
    to_first = first.m_appliedImpulse + wanted_first * (step / first.m_jacDiagABInv);
    to_second = second.m_appliedImpulse + wanted_second * (step / second.m_jacDiagABInv);
    const btScalar length = btSqrt(to_first * to_first + to_second * to_second);
    if (length > limit) {
      to_first *= limit / length;
      to_second *= limit / length;
    }
  }
  const btScalar impulse_first = to_first - first.m_appliedImpulse;
  const btScalar impulse_second = to_second - second.m_appliedImpulse;
  apply(first, impulse_first);
  apply(second, impulse_second);
  return btMax(btFabs(impulse_first / first.m_jacDiagABInv),
               btFabs(impulse_second / second.m_jacDiagABInv));
}

/// Rows come in pairs that belong to one contact, whose normal impulse limits them.
btScalar Solver::solve_friction(btMultiBodyConstraintArray& rows) {
  btScalar most = 0;
  for (int i = 0; i + 1 < rows.size(); i += 2) {
    const Row& first = rows[i];
    const btScalar normal =
        m_multiBodyNormalContactConstraints[first.m_frictionIndex].m_appliedImpulse;
    most = btMax(most,
                 solve_friction(first, rows[i + 1], first.m_friction * btMax(normal, btScalar(0))));
  }
  return most;
}

/// Begins with most of what each contact carried a substep ago.
void Solver::warm_start() {
  for (int i = 0; i < m_multiBodyNormalContactConstraints.size(); ++i) {
    const Row& row = m_multiBodyNormalContactConstraints[i];
    const auto& point = *static_cast<const btManifoldPoint*>(row.m_originalContactPoint);
    if (row.m_jacDiagABInv != 0) apply(row, warm_start_share * point.m_appliedImpulse);
  }
}

btScalar Solver::solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                      btPersistentManifold** manifolds, int manifold_count,
                                      btTypedConstraint** constraints, int constraint_count,
                                      const btContactSolverInfo& info, btIDebugDraw* draw) {
  const int joints = m_multiBodyNonContactConstraints.size();
  const int contacts = m_multiBodyNormalContactConstraints.size();
  // A residual of nothing ends the sweeps.
  if (joints + contacts == 0 && iteration >= sweeps_per_body_ * body_count) return 0;
  const btScalar rigid = btSequentialImpulseConstraintSolver::solveSingleIteration(
      iteration, bodies, body_count, manifolds, manifold_count, constraints, constraint_count, info,
      draw);
  if (iteration == 0) warm_start();
  btScalar most = 0;
  for (int i = 0; i < joints; ++i) {
    const int index = iteration & 1 ? i : joints - 1 - i;
    most = btMax(most, btFabs(solve_row(m_multiBodyNonContactConstraints[index])));
  }
  for (int i = 0; i < contacts; ++i) {
    most = btMax(most, btFabs(solve_row(m_multiBodyNormalContactConstraints[i])));
  }
  most = btMax(most, solve_friction(m_multiBodyTorsionalFrictionContactConstraints));
  most = btMax(most, solve_friction(m_multiBodyFrictionContactConstraints));
  return btMax(rigid, most * most);
}

}  // namespace ziggurat::physics
