#include "simulation/simulation.h"

#include <cmath>

#include "physics/world.h"
#include "simulation/layout.h"
#include "simulation/place.h"

namespace ziggurat::simulation {
namespace {

/// Physical time that a substep covers [s].
double substep_length(const scene::Scene& scene, const Options& options) {
  const double tick = 1.0 / scene.experiment.ticks_per_second;
  const double iterations = scene.physics.iterations;
  const bool slow = options.clock.value_or(scene.physics.clock) == scene::Clock::beta50;
  return slow ? tick / (iterations * iterations) : tick / iterations;
}

/// Index into Entity::joints; the reader has made sure that it is there.
std::size_t find_joint(const scene::Entity& entity, const std::string& id) {
  std::size_t joint = 0;
  while (entity.joints[joint].id != id) ++joint;
  return joint;
}

bool has_coordinate(const scene::Joint& joint) {
  return joint.type == scene::JointType::revolute || joint.type == scene::JointType::prismatic;
}

}  // namespace

struct Simulation::Parts {
  Parts(const scene::Scene& scene, const Options& options);

  void sense();

  struct Sensor {
    physics::JointIndex joint;
    bool velocity = false;
    bool disabled = false;
  };

  unsigned ticks_per_second;
  unsigned substeps;
  double substep;  // [s]
  physics::World physics;
  world::Layout layout;
  world::State state;
  world::Observations observations;
  world::Commands commands;
  std::vector<physics::JointIndex> actuators;  // parallel to Layout::joint_actuators
  std::vector<Sensor> sensors;                 // parallel to Layout::joint_sensors
};

Simulation::Parts::Parts(const scene::Scene& scene, const Options& options)
    : ticks_per_second(scene.experiment.ticks_per_second),
      substeps(scene.physics.iterations),
      substep(substep_length(scene, options)),
      physics(scene.physics, substep) {
  const std::vector<scene::Entity> entities = place(scene, options.seed);
  layout = make_layout(scene, entities);
  for (const scene::Entity& entity : entities) physics.add(entity);
  for (const world::RobotLayout& robot : layout.robots) {
    const scene::Entity& entity = entities[robot.entity];
    const scene::ControllerDevices& devices = scene.controllers[robot.controller].devices;
    for (const scene::JointActuator& actuator : devices.joint_actuators) {
      actuators.push_back(physics.joint(robot.entity, find_joint(entity, actuator.joint)));
      physics.add_motor(actuators.back(), actuator.mode, actuator.max_impulse);
    }
    for (const scene::JointSensor& sensor : devices.joint_sensors) {
      const std::size_t joint = find_joint(entity, sensor.joint);
      if (sensor.mode == scene::JointMode::disabled || !has_coordinate(entity.joints[joint])) {
        sensors.push_back({{}, false, true});
      } else {
        sensors.push_back({physics.joint(robot.entity, joint),
                           sensor.mode == scene::JointMode::velocity, false});
      }
    }
  }
  commands.joint_targets.assign(actuators.size(), 0);
  observations.joint_readings.assign(sensors.size(), 0);
  physics.read(state);
}

void Simulation::Parts::sense() {
  observations.tick = state.tick;
  observations.time_ns = state.time_ns;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const Sensor& sensor = sensors[i];
    if (sensor.disabled) continue;
    observations.joint_readings[i] =
        sensor.velocity ? physics.velocity(sensor.joint) : physics.position(sensor.joint);
  }
}

Simulation::Simulation(const scene::Scene& scene, const Options& options)
    : parts_(std::make_unique<Parts>(scene, options)) {}
Simulation::~Simulation() = default;

const world::Layout& Simulation::layout() const { return parts_->layout; }
const world::State& Simulation::state() const { return parts_->state; }
const world::Observations& Simulation::observations() const { return parts_->observations; }
world::Commands& Simulation::commands() { return parts_->commands; }

void Simulation::step() {
  Parts& p = *parts_;
  for (std::size_t i = 0; i < p.actuators.size(); ++i) {
    p.physics.set_target(p.actuators[i], p.commands.joint_targets[i]);
  }
  for (unsigned i = 0; i < p.substeps; ++i) p.physics.step();
  p.state.tick += 1;
  p.state.time_ns = std::llround(static_cast<long double>(p.state.tick) * 1e9L / p.ticks_per_second);
  p.physics.read(p.state);
  p.sense();
}

std::uint64_t Simulation::hash() const { return world::hash(parts_->state, parts_->observations); }
double Simulation::tick_length() const { return 1.0 / parts_->ticks_per_second; }
double Simulation::physical_length() const { return parts_->substep * parts_->substeps; }

}  // namespace ziggurat::simulation
