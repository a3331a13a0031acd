#pragma once
// What is true at one tick, what robots are told of it, and what they answered.

#include <cstdint>
#include <vector>

#include "math/hash.h"
#include "math/pose.h"
#include "world/layout.h"

namespace ziggurat::world {

struct LinkState {
  math::Pose pose;                                            ///< X_WL of the bottom-centre frame
  math::Vector3 velocity = math::Vector3::Zero();             ///< of the frame's origin, in W [m/s]
  math::Vector3 angular_velocity = math::Vector3::Zero();     ///< in W [rad/s]
};

struct State {
  std::uint64_t tick = 0;
  std::int64_t time_ns = 0;            ///< simulated: round(tick * 1e9 / ticks_per_second)
  std::vector<math::Pose> origins;     ///< X_WE per entity
  std::vector<LinkState> links;        ///< of all entities, in scene order
};

/// What all robots sense at one tick, packed in scene order.
struct Observations {
  std::uint64_t tick = 0;
  std::int64_t time_ns = 0;
  std::vector<double> joint_readings;  ///< [m], [rad], [m/s] or [rad/s] as the sensor's mode says
};

/// What all robots want, packed in scene order. Values persist until changed.
struct Commands {
  std::vector<double> joint_targets;  ///< [m], [rad], [m/s] or [rad/s] as the actuator's mode says
};

/// Hash of a state and what was sensed in it: equal for equal runs, whatever the transport.
std::uint64_t hash(const State& state, const Observations& observations);

}  // namespace ziggurat::world
