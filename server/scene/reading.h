#pragma once
// The parts of a scene file, each read by its own function into its own struct, and what they
// need from each other on the way. Read in this order: framework, physics engines (their defaults
// reach into the arena), media, controllers, arena.

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "scene/document.h"
#include "scene/names.h"
#include "scene/scene.h"

namespace ziggurat::scene {

/// What <dynamics3d> says for all bodies; where it says nothing, each kind of body has its own.
struct BodyDefaults {
  std::optional<double> friction, rolling_friction, linear_damping, angular_damping;
};

/// A device that a controller enables, and what an entity must have for it.
struct DeviceUse {
  std::string name;  ///< of the element: "radios"
  Location where;
};

/// What must be known of a controller when an entity uses it.
struct ControllerUse {
  bool has_actuators = false, has_sensors = false, has_params = false;
  std::vector<DeviceUse> devices;
  std::vector<Location> camera_anchors;  ///< of Controller::devices.cameras, same order
  unsigned faults = 0;                   ///< found with entities so far
};

struct Reading {
  Document& document;
  Scene& scene;
  BodyDefaults defaults;
  bool has_engine = false;
  std::vector<ControllerUse> uses;                           ///< of Scene::controllers, same order
  std::unordered_map<std::string, std::size_t> media;        ///< id -> index
  std::unordered_map<std::string, std::size_t> controllers;  ///< id -> index
  std::set<std::pair<unsigned, unsigned>> blamed;  ///< device locations reported once already
  Ids entity_ids;
  std::unordered_map<std::string, std::size_t> anchors;  ///< link id -> index, of the entity
                                                         ///< being read
};

void read_framework(Reading& reading, Element& root);
void read_engines(Reading& reading, Element& root);
void read_media(Reading& reading, Element& root);
void read_controllers(Reading& reading, Element& root);
void read_arena(Reading& reading, Element& root);

// --- controllers --------------------------------------------------------------------------------

/// Reads <actuators> and <sensors>.
void read_actuators(Reading& reading, Element& list, ControllerDevices& devices,
                    ControllerUse& use);
void read_sensors(Reading& reading, Element& list, ControllerDevices& devices, ControllerUse& use);
std::vector<Camera> read_cameras(Reading& reading, Element& sensor, ControllerUse& use);

/// The last child of each name, in the order of those; earlier ones of the name are a notice.
std::vector<Element> last_of_each_name(Element& list);

/// Reads an entity's <controller> and checks that it has what the controller needs.
void read_controller_of(Reading& reading, Element& element, Entity& entity);

// --- entities -----------------------------------------------------------------------------------

/// How an entity is written: in the arena, or as the pattern of a <distribute>.
enum class Placement { explicit_pose, distributed };

/// Reads <box>, <cylinder>, <prototype>, <foot-bot> or <e-puck>.
Entity read_entity(Reading& reading, Element& element, Placement placement);
bool is_entity(std::string_view name);

/// Reads a <foot-bot> or <e-puck> into an entity that knows its kind.
void read_robot(Reading& reading, Element& element, Entity& entity, Placement placement);

/// Reads <light>, whose effects are still to come; returns its id.
std::string read_light(Reading& reading, Element& element, Placement placement);

void read_distribution(Reading& reading, Element& element);

/// `<body>` of an entity: its pose.
math::Pose read_body(Element& element, Placement placement);

/// `position` and `orientation` of any element, both optional.
math::Pose read_pose(Element& element);

/// Reads <links>; false if links can't be told apart or no reference link is known.
bool read_links(Reading& reading, Element& element, Entity& entity);

/// Reads <joints> and, if the tree is `rooted`, orders them from the root outwards.
void read_joints(Reading& reading, Element& element, Entity& entity, bool rooted);

/// Checks that joints make a tree with the reference link at its root, and orders them.
void order_joints(Document& document, Entity& entity);

/// Reads <devices> of a prototype.
void read_devices(Reading& reading, Element& element, Entity& entity);

/// Reads <battery>.
Battery read_battery(Element& element);

/// Reads <leds> of a box, cylinder or prototype.
void read_leds(Reading& reading, Element& container, Entity& entity);

// --- shared values ------------------------------------------------------------------------------

/// `friction` and `rolling_friction`.
Surface read_surface(Reading& reading, Element& element, const Surface& usual);

/// `linear_damping` and `angular_damping`.
Damping read_damping(Reading& reading, Element& element, const Damping& usual);

/// The medium that an attribute `medium` names; a missing, unknown or wrong one is a fault.
std::optional<std::size_t> read_medium(Reading& reading, Element& element, MediumKind kind);

/// The anchor that an attribute `anchor` names; an unknown one is a fault.
Anchor read_anchor(Reading& reading, Element& element);

/// `origin`, then the links of the entity being read.
std::vector<std::string> anchor_names(const Reading& reading);

/// The dialect's name of a kind of medium.
std::string_view to_string(MediumKind kind);

}  // namespace ziggurat::scene
