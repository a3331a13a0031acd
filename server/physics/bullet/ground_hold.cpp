#include "physics/bullet/ground_hold.h"

namespace ziggurat::physics {

void GroundHold::getInfo1(btConstraintInfo1* info) {
  info->m_numConstraintRows = 3;
  info->nub = 3;
}

void GroundHold::getInfo2(btConstraintInfo2* info) {
  const btVector3* directions[] = {&motion_.along, &motion_.across};
  const btScalar wanted[] = {motion_.speed, 0, motion_.angular_velocity};
  for (int row = 0; row < 3; ++row) {
    const int place = row * info->rowskip;
    for (int axis = 0; axis < 3 && row < 2; ++axis) {
      info->m_J1linearAxis[place + axis] = (*directions[row])[axis];
    }
    if (row == 2) info->m_J1angularAxis[place + 2] = 1;
    const btScalar most =
        (row < 2 ? motion_.limits.max_force : motion_.limits.max_torque) * motion_.time_step;
    info->m_constraintError[place] = wanted[row];
    info->m_lowerLimit[place] = -most;
    info->m_upperLimit[place] = most;
  }
}

}  // namespace ziggurat::physics
