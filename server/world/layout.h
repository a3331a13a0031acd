#pragma once
// Who is in the world, in scene order: the names and positions that every flat array of State,
// Observations and Commands is indexed by. Fixed for the life of a simulation.

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace ziggurat::world {

/// A run of elements in a flat array.
struct Range {
  std::size_t begin = 0;
  std::size_t count = 0;
  std::size_t end() const { return begin + count; }
};

struct EntityLayout {
  std::string id;
  Range links;          ///< into State::links; every entity has at least one
  bool lists_links = false;  ///< a trace has a row per link (prototypes and robots)
};

struct LinkLayout {
  std::string id;  ///< empty for a box or cylinder entity
  std::size_t entity = 0;
};

/// A readable joint: an entry of Observations::joint_readings.
struct JointSensorLayout {
  std::string id;
  bool velocity = false;  ///< reads q' [m/s, rad/s] instead of q [m, rad]
  bool disabled = false;  ///< always reads 0
};

/// A settable joint: an entry of Commands::joint_targets.
struct JointActuatorLayout {
  std::string id;
  bool velocity = false;
  bool disabled = false;   ///< targets are accepted and have no effect
  double max_impulse = 0;  ///< per substep as written in the scene [N s, N m s]
};

/// An entity with a controller.
struct RobotLayout {
  std::string id;
  std::size_t entity = 0;      ///< into Layout::entities
  std::size_t controller = 0;  ///< into scene::Scene::controllers
  std::vector<std::pair<std::string, std::string>> params;
  Range joint_sensors;    ///< into Layout::joint_sensors and Observations::joint_readings
  Range joint_actuators;  ///< into Layout::joint_actuators and Commands::joint_targets
};

struct Layout {
  std::vector<EntityLayout> entities;
  std::vector<LinkLayout> links;
  std::vector<RobotLayout> robots;
  std::vector<JointSensorLayout> joint_sensors;
  std::vector<JointActuatorLayout> joint_actuators;
};

}  // namespace ziggurat::world
