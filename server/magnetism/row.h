// SPDX-License-Identifier: MIT
#pragma once
// Rows of the kernels as vectors. Kernels themselves do without: Eigen must not be compiled for
// more than one instruction set.

#include "magnetism/dipole.h"
#include "magnetism/kernel.h"

namespace ziggurat::magnetism {

inline Vector3 vector(const Row& row) { return {row.x, row.y, row.z}; }
inline Row row(const Vector3& v, double w = 0) { return {v.x(), v.y(), v.z(), w}; }

}  // namespace ziggurat::magnetism
