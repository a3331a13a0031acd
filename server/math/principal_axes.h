#pragma once

#include <Eigen/Core>

#include "math/pose.h"

namespace ziggurat::math {

/// Principal axes of an inertia as a rotation; none where the inertia is diagonal already.
Quaternion principal_axes(const Eigen::Matrix3d& inertia);

}  // namespace ziggurat::math
