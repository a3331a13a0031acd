// SPDX-License-Identifier: MIT
#pragma once
// The entities of the world in scene order: names, and positions in the flat arrays of State,
// Observations and Commands. While a world runs it only grows: a new entity stands behind all
// others, one that is removed leaves its places empty (State::absent).

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "world/devices.h"

namespace ziggurat::world {

struct EntityLayout {
  std::string id;
  Range links;                  ///< into State::links; every entity has at least one
  bool lists_links = false;     ///< a trace has a row per link (prototypes and robots)
  Range leds = {};              ///< all that it carries, whether a robot sets them or not: into
  Range directional_leds = {};  ///< the lists of the same names
  Range tags = {};
};

struct LinkLayout {
  std::string id;  ///< empty for a box or cylinder entity
  std::size_t entity = 0;
};

/// An entity with a controller.
struct RobotLayout : DeviceRanges {
  std::string id;
  std::size_t entity = 0;      ///< into Layout::entities
  std::size_t controller = 0;  ///< into scene::Scene::controllers
  bool draws_markers = false;  ///< its controller has the actuator
  std::vector<std::pair<std::string, std::string>> params;
};

struct Layout : DeviceLists {
  std::vector<EntityLayout> entities;
  std::vector<LinkLayout> links;
  std::vector<RobotLayout> robots;
};

}  // namespace ziggurat::world
