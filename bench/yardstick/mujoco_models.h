// SPDX-License-Identifier: MIT
#pragma once
// MuJoCo models for the yardstick.

#include <mujoco/mujoco.h>

#include <initializer_list>
#include <string>

#include "math/pose.h"

namespace ziggurat::yardstick {

/// A text with {1}, {2}, … replaced by numbers.
std::string text(std::string pattern, std::initializer_list<double> numbers);

struct Model {
  /// @param bodies   what stands in <worldbody>
  /// @param length   of a step [s]
  /// @param gravity  [m/s^2]
  /// @param motors   what stands in <actuator>
  /// @throws std::runtime_error if MuJoCo does not take it
  Model(const std::string& bodies, double length, const math::Vector3& gravity,
        const char* integrator = "Euler", const std::string& motors = "");
  ~Model();
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;

  void without_contacts();
  void stiffen();  ///< contacts: as far as MuJoCo takes it for this step
  void step() { mj_step(model, data); }
  void run(double seconds);
  double energy();                      ///< potential and kinetic [J]
  math::Vector3 place(int body) const;  ///< of its frame; 0: the world [m]

  mjModel* model = nullptr;
  mjData* data = nullptr;
};

/// A robot on two wheels and two casters, with joints "<number>l" and "<number>r".
std::string robot(const math::Vector3& at, int number);

}  // namespace ziggurat::yardstick
