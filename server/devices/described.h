// SPDX-License-Identifier: MIT
#pragma once
// Base of the kinds of devices that describe themselves: their places in the layout, their values,
// and a random stream of each robot. A kind says what its devices read.

#include <cstddef>
#include <span>
#include <vector>

#include "devices/kind.h"
#include "math/random.h"
#include "world/described.h"

namespace ziggurat::devices {

class Described : public Kind {
 public:
  void lay_out(const Carrier& carrier, world::RobotLayout& robot,
               world::Layout& layout) const final;
  void add(const Setting& setting) final;
  void start(Tick& tick) final;
  void apply(Tick& tick) override;
  void sense(Tick& tick) final;
  void archive(math::Archive& archive) override;

 protected:
  /// A robot that has devices of the kind.
  struct Robot {
    std::size_t index;                       ///< into Layout::robots
    world::Range devices;                    ///< of the kind, into Layout::described
    std::vector<scene::DevicePlace> places;  ///< of each device
    scene::DescribedUse use;
    math::RandomStream random;
  };

  /// @param kind  outlives the world
  explicit Described(const world::DeviceKind& kind) : kind_(kind) {}

  /// Before physics, of each robot in the world whose controller has the actuator: what its first
  /// device was commanded takes effect.
  /// @param number  of the robot, into robots();  @param entity  its entity
  virtual void act(Tick& /*tick*/, std::size_t /*number*/, std::size_t /*entity*/,
                   std::span<const double> /*commands*/) {}
  /// After physics, of each robot in the world whose controller has the sensor: writes its
  /// readings, which are 0, or no rows, at tick 0.
  virtual void read(Tick& tick, Robot& robot) = 0;
  /// The properties of a device, as described.
  virtual std::vector<double> properties(const scene::DevicePlace& /*place*/) const { return {}; }
  /// Distance within which a device looks for LEDs [m]; 0: for none.
  virtual double sight(const scene::DevicePlace& /*place*/) const { return 0; }
  /// Takes in a robot, the last one.
  virtual void add_robot(const Setting& /*setting*/) {}
  /// Takes in what else the kind looks for.
  virtual void add_others(const Setting& /*setting*/) {}

  const world::DeviceKind& kind() const { return kind_; }
  std::span<const Robot> robots() const { return robots_; }

  /// Adds the noise of the robot's sensor, uniform.
  static double with_noise(Robot& robot, double reading);

 private:
  const world::DeviceKind& kind_;
  std::vector<Robot> robots_;
  std::size_t started_ = 0;  // of the robots
};

}  // namespace ziggurat::devices
