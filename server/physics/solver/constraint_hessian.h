// SPDX-License-Identifier: MIT
#pragma once
// Contribution of a constraint's linearised law to the matrix of an island. It is most of the work
// of Newton's method, so the compiler knows the sizes of robots with few joints.

#include <vector>

#include "physics/solver/block_matrix.h"
#include "physics/solver/problem.h"

namespace ziggurat::dynamics {

/// matrix += J^T H J, with H the law's Hessian, in the blocks of the trees that the constraint acts
/// on.
/// @param memory  to work in
void add_constraint_hessian(const Problem& problem, const Constraint& constraint,
                            const LinearisedLaw& linear, std::vector<double>& memory,
                            BlockMatrix& matrix);

}  // namespace ziggurat::dynamics
