// SPDX-License-Identifier: MIT
#pragma once
// Content of a scene file as plain data. Everything is resolved to SI units, radians and
// quaternions, names to indices, and defaults are filled in. Degrees and XML end in the reader.
//
// Frames: Z up, right-handed. W world, E entity origin, L link, J joint. scene/geometry.h gives the
// frames of shapes.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "images/image.h"
#include "math/pose.h"
#include "scene/deadline.h"
#include "scene/devices.h"
#include "scene/geometry.h"
#include "scene/problem.h"

namespace ziggurat::scene {

// --- variation --------------------------------------------------------------------------------

/// A value for all attributes that a path names: `--set`.
struct Setting {
  std::string path;  ///< XPath from the root element: `physics_engines/dynamics3d/@iterations`
  std::string value;
};

/// Variation of a run against its scene file, apart from options with a name of their own.
struct Variation {
  std::vector<Setting> settings;                                ///< in order: later ones win
  std::vector<std::pair<std::string, std::string>> parameters;  ///< names and values: `--param`
};

/// One line for each, for hashes; empty if there are none.
std::string to_text(const Variation& variation);

// --- time -------------------------------------------------------------------------------------

/// Physical time of a tick, as the sum of its substeps.
enum class Clock {
  nominal,  ///< a tick is 1/ticks_per_second s, in `iterations` equal substeps
  beta50,   ///< `iterations` substeps of 1/(ticks_per_second * iterations^2) s: the slow clock
            ///< of ARGoS 3.0.0-beta50, for scenes whose parameters were tuned under it
};

struct Experiment {
  unsigned ticks_per_second = 10;  ///< >= 1
  double length = 0;               ///< [s] simulated; 0 = until stopped
  std::uint64_t random_seed = 0;   ///< 0 = drawn from the system at the start
  bool real_time = false;          ///< pace ticks to the wall clock
};

// --- bodies -----------------------------------------------------------------------------------

/// Friction and restitution of a surface.
struct Surface {
  double friction = 0.5;           ///< Coulomb coefficient; two surfaces combine by product
  double rolling_friction = 0.0;   ///< [m]: resisting torque per normal force; by sum
  double spinning_friction = 0.0;  ///< [m]: the same against turning about the normal; by sum
  double restitution = 0.0;        ///< speed after an impact over speed before, 0 to 1; by maximum
};

/// Viscous loss of a body: force -m v (k + k |v|), torque -I w (k + k |w|).
struct Damping {
  double linear = 0.0;   ///< k for the velocity [1/s and 1/m]
  double angular = 0.0;  ///< k for the angular velocity [1/s and 1]
  /// Whether each is only what the dialect takes where the file says nothing: without effect at the
  /// nominal clock.
  bool usual_linear = false, usual_angular = false;
};

struct Link {
  std::string id;  ///< also the name of the link's anchor
  Geometry geometry;
  bool collides = true;  ///< false: a frame without body (a foot-bot's turret), its shape a point
  double mass = 0;       ///< [kg]; > 0 unless the link is static
  math::Pose offset;     ///< X_EL as written: only the reference link's decides where it stands,
                         ///< joints place all others
  Surface surface;
  Damping damping;
  Location where;
};

enum class JointType { fixed, spherical, prismatic, revolute };

/// Whether a joint moves along or about an axis, so that it has one coordinate, limits and motors.
constexpr bool has_coordinate(JointType type) {
  return type == JointType::prismatic || type == JointType::revolute;
}

struct JointLimit {
  double lower = 0;  ///< [m] or [rad], relative to the assembled pose; <= upper
  double upper = 0;  ///< [m] or [rad]
};

struct Joint {
  std::string id;
  JointType type = JointType::fixed;
  math::Vector3 axis = math::Vector3::UnitZ();  ///< unit, in the child link's frame
  std::optional<JointLimit> limit;              ///< prismatic and revolute only
  std::size_t parent = 0;                       ///< index into Entity::links
  std::size_t child = 0;                        ///< index into Entity::links
  math::Pose parent_frame;                      ///< X_LJ of the joint in the parent link
  math::Pose child_frame;                       ///< X_LJ of the joint in the child link
  Location where;
};

enum class EntityKind {
  box,
  cylinder,
  sphere,
  prototype,
  light,
  foot_bot,
  e_puck,
  eye_bot,
  spiri,
  mini_quadrotor,
  kilobot,
  pi_puck,
  builderbot,
  khepera,
};

/// The name of its element.
std::string_view to_string(EntityKind kind);

/// Whether it is a robot that comes as it is, with a controller.
bool is_robot(EntityKind kind);

/// Whether it is one body or light and no more, without joints, controller or name for its link.
constexpr bool is_single(EntityKind kind) {
  return kind == EntityKind::box || kind == EntityKind::cylinder || kind == EntityKind::sphere ||
         kind == EntityKind::light;
}

/// Traction that keeps a body upright and holds its motion over the ground. It is that of driven
/// wheels, or the braking friction of the ground in a two-dimensional engine.
struct Traction {
  double max_force = 0;   ///< along its x axis, and as much across it [N]
  double max_torque = 0;  ///< about z [N m]
};

/// Limits of a flying body, which its rotors hold up, upright and where it is to be.
struct Flight {
  double max_speed = 0;              ///< that it aims at [m/s]
  double max_acceleration = 0;       ///< beyond what balances gravity [m/s^2]
  double max_turn_rate = 0;          ///< that it aims at [rad/s]
  double max_turn_acceleration = 0;  ///< [rad/s^2]
};

/// Anything that stands in the arena. A `<box>` is an entity with one unnamed link.
struct Entity {
  std::string id;
  EntityKind kind = EntityKind::prototype;
  bool movable = true;                ///< false: the reference link is welded to the world
  math::Pose pose;                    ///< X_WE at tick 0 (a distributed entity: set when placed)
  std::vector<Link> links;            ///< in document order, at least one
  std::size_t reference_link = 0;     ///< index into links: the root of the tree
  std::vector<Joint> joints;          ///< ordered from the root outwards: a joint's parent link is
                                      ///< the reference link or the child of an earlier joint
  std::optional<Traction> traction;   ///< robots on wheels; their body is the reference link
  std::optional<double> axle_length;  ///< distance between its two driven wheels [m]
  std::optional<Flight> flight;       ///< robots that fly; their body is the reference link
  std::optional<std::size_t> turret;  ///< index into links: a frame that turns about its z
  bool is_grippable = false;          ///< grippers may hold it
  std::optional<double> intensity;    ///< of a light, which has one LED and no body; >= 0
  Devices devices;
  std::optional<std::size_t> controller;                    ///< index into Scene::controllers
  std::vector<std::pair<std::string, std::string>> params;  ///< the entity's own <params>, if
  bool overrides_params = false;     ///< it has one, replacing the controller's
  Location params_where;             ///< of that <params>
  std::optional<std::size_t> model;  ///< index into Scene::models; none: written out
  Location where;
};

// --- distribution -----------------------------------------------------------------------------

enum class DistributionMethod { uniform, gaussian, constant, grid };

/// Draws triples: positions [m], or `z,y,x` angles in degrees as the dialect writes them.
struct Generator {
  DistributionMethod method = DistributionMethod::constant;
  math::Vector3 first = math::Vector3::Zero();   ///< min, mean, values or center
  math::Vector3 second = math::Vector3::Zero();  ///< max, std_dev, unused or distances
  std::array<unsigned, 3> layout{1, 1, 1};       ///< grid only: cells along x, y, z
};

struct Distribution {
  Generator position;
  Generator orientation;
  unsigned quantity = 0;
  unsigned max_trials = 0;  ///< retries per entity; at most max_trials + 1 attempts
  unsigned base_num = 0;    ///< the i-th copy is called id + (base_num + i)
  Entity entity;            ///< the pattern; its id is the base of the copies' ids
  Location where;
};

// --- physics and media ------------------------------------------------------------------------

struct Floor {
  double height = 0;  ///< [m] accepted and drawn; the floor is the half-space z <= 0
  Surface surface;
};

struct Magnetism {
  double force_constant = 7.0500949e-13;  ///< k of the dialect's pair force
  std::optional<double> max_distance;     ///< pair cut-off [m]; none = unlimited
  bool adaptive = false;    ///< magnets with a shape are as many sources as the tolerance asks for
  double tolerance = 0.01;  ///< relative, of the force and torque of a pair; adaptive only
  double taper = 0;         ///< share of max_distance over which forces fade out, 0 to 1
};

/// A `<dynamics2d>`: what stands at its elevation keeps that height.
struct Plane {
  double elevation = 0;           ///< [m]
  Traction box{1.49, 1.49};       ///< how its ground brakes boxes
  Traction cylinder{1.49, 1.49};  ///< and cylinders
};

struct Physics {
  std::string id;
  unsigned iterations = 10;  ///< substeps per tick, >= 1
  Clock clock = Clock::nominal;
  /// Whether earlier versions moved it by a second core: by solver="sweeps", or under beta50
  /// without a solver. A recording of theirs can't be repeated.
  bool had_second_core = false;
  std::optional<double> max_substep;  ///< [s]: longer substeps are split inside
  std::optional<Floor> floor;
  std::optional<double> gravity;  ///< downward acceleration [m/s^2]
  std::optional<Magnetism> magnetism;
  std::vector<Plane> planes;  ///< in document order
  bool flat = false;          ///< there are planes only: they hold boxes and cylinders, too
  Location where;
};

enum class MediumKind {
  led,
  directional_led,
  tag,
  radio,
  range_and_bearing,
  kilobot_communication
};

struct Medium {
  std::string id;
  MediumKind kind;
  bool checks_occlusions = true;  ///< range_and_bearing: bodies in between stop packets
  Location where = {};
};

struct Arena {
  math::Vector3 size = math::Vector3::Ones();    ///< full extents [m]
  math::Vector3 center = math::Vector3::Zero();  ///< [m]
};

/// The floor of an arena, which its image covers.
inline images::Rectangle ground_of(const Arena& arena) {
  return {{arena.center.x(), arena.center.y()}, {arena.size.x(), arena.size.y()}};
}

// --- controllers ------------------------------------------------------------------------------

struct Controller {
  std::string id;
  std::string type;     ///< the element's name: lua_controller, external_controller, …
  bool lua = false;     ///< driven by ziggurat-lua; otherwise a client connects
  std::string command;  ///< external_controller only: what `run` starts; may be empty
  std::optional<DeadlinePolicy> deadline;  ///< for when it is late; nothing: the scene has no say
  ControllerDevices devices;               ///< what <actuators> and <sensors> enable
  std::vector<std::pair<std::string, std::string>> params;  ///< all attributes of <params>
  Location where;                                           ///< of the controller's element
  Location params_where;                                    ///< of <params>
};

/// Whether other versions load a library for it. Here a program may be started in its place.
bool is_library(const Controller& controller);

/// A program that watches the whole world and acts on it between ticks.
struct Director {
  static constexpr std::size_t most = 4;  ///< of a world

  std::string id;
  std::string script;   ///< that ziggurat-lua runs, as written; empty: none
  std::string command;  ///< what `run` starts; empty: none, and without script a client connects
  std::optional<DeadlinePolicy> deadline;  ///< for when it is late; nothing: the scene has no say
  std::vector<std::pair<std::string, std::string>> params;  ///< all attributes of <params>
  Location where;
};

/// Something that many entities are alike in, `<models>` in the file.
struct ModelName {
  std::string id;
  Location where;  ///< of its definition
  EntityKind kind = EntityKind::prototype;
};

struct Scene {
  Variation variation;             ///< that it was read with
  std::vector<std::string> files;  ///< what Location::file counts; [0] is the scene file
  Experiment experiment;
  std::vector<std::pair<std::string, std::string>> run;  ///< names and values of <run>
  std::vector<Controller> controllers;
  std::vector<Director> directors;
  std::vector<ModelName> models;
  Arena arena;
  std::shared_ptr<const images::Image> floor_image;  ///< over the whole arena; null: it is white
  std::vector<Entity> entities;                      ///< explicitly placed, in document order
  std::vector<Distribution> distributions;
  Physics physics;
  std::vector<Medium> media;
};

}  // namespace ziggurat::scene
