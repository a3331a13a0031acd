// SPDX-License-Identifier: MIT
#pragma once
// Spatial vectors (R. Featherstone, Rigid Body Dynamics Algorithms, 2008, chapter 2). All are in
// world axes about one common point O, so quantities of different links add up without transforms.

#include "math/pose.h"

namespace ziggurat::math {
class Archive;
}

namespace ziggurat::dynamics {

using math::Quaternion;
using math::Vector3;
using Matrix3 = Eigen::Matrix3d;

/// A velocity or an acceleration of a rigid body.
struct Motion {
  Vector3 angular{0, 0, 0};  ///< [rad/s]
  Vector3 linear{0, 0, 0};   ///< of the body's point that passes through O [m/s]
};

/// A force, an impulse or a momentum.
struct Wrench {
  Vector3 moment{0, 0, 0};  ///< about O [N m]
  Vector3 force{0, 0, 0};   ///< [N]
};

inline Motion operator+(const Motion& a, const Motion& b) {
  return {a.angular + b.angular, a.linear + b.linear};
}
inline Motion operator*(const Motion& a, double factor) {
  return {a.angular * factor, a.linear * factor};
}
inline Wrench operator+(const Wrench& a, const Wrench& b) {
  return {a.moment + b.moment, a.force + b.force};
}
inline Wrench operator-(const Wrench& a, const Wrench& b) {
  return {a.moment - b.moment, a.force - b.force};
}

/// Power of a wrench on a motion [W].
inline double dot(const Motion& motion, const Wrench& wrench) {
  return motion.angular.dot(wrench.moment) + motion.linear.dot(wrench.force);
}

/// Rate of change of a motion that is fixed in a body that moves with v.
inline Motion cross(const Motion& v, const Motion& m) {
  return {v.angular.cross(m.angular), v.angular.cross(m.linear) + v.linear.cross(m.angular)};
}

/// Rate of change of a wrench that is fixed in a body that moves with v.
inline Wrench cross(const Motion& v, const Wrench& w) {
  return {v.angular.cross(w.moment) + v.linear.cross(w.force), v.angular.cross(w.force)};
}

/// Inertia of one or several rigid bodies about O.
struct Inertia {
  double mass = 0;                          ///< [kg]
  Vector3 first_moment{0, 0, 0};            ///< mass times the centre of mass from O [kg m]
  Matrix3 second_moment = Matrix3::Zero();  ///< about O, symmetric [kg m^2]

  Inertia& operator+=(const Inertia& other) {
    mass += other.mass;
    first_moment += other.first_moment;
    second_moment += other.second_moment;
    return *this;
  }
};

/// Momentum of a body of this inertia that moves with v.
inline Wrench operator*(const Inertia& inertia, const Motion& v) {
  return {inertia.second_moment * v.angular + inertia.first_moment.cross(v.linear),
          inertia.mass * v.linear + v.angular.cross(inertia.first_moment)};
}

}  // namespace ziggurat::dynamics
