#pragma once
// What a block's linearised law adds to the matrix of an island: most of the work of a Newton step
// of a robot, so sizes are known to the compiler where robots have few joints.

#include <vector>

#include "dynamics/block_matrix.h"
#include "dynamics/contact_law.h"

namespace ziggurat::dynamics {

/// matrix += J^T slope J, in the blocks of the one or two trees that the block acts on.
/// @param memory  to work in
void add_constraint_hessian(const Problem& problem, const Constraint& constraint, const LinearisedLaw& linear,
               std::vector<double>& memory, BlockMatrix& matrix);

}  // namespace ziggurat::dynamics
