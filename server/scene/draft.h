// SPDX-License-Identifier: MIT
#pragma once
// A scene while it is read: its parts, each read by its own function into its own struct, and what
// these need from each other. Read in this order: includes, framework, physics engines (their
// defaults reach into the arena), media, controllers, models, arena.

#include <cstddef>
#include <deque>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "scene/document.h"
#include "scene/element.h"
#include "scene/names.h"
#include "scene/parameters.h"
#include "scene/scene.h"

namespace ziggurat::scene {

/// Values of <dynamics3d> for all bodies; without one, each kind of body has its own default.
struct BodyDefaults {
  std::optional<double> friction, rolling_friction, spinning_friction, restitution;
  std::optional<double> linear_damping, angular_damping;
};

/// A device that a controller enables, and what an entity must have for it.
struct DeviceUse {
  std::string name;  ///< of the element: "radios"
  Location where;
  std::string_view places = {};  ///< of one that describes itself: DevicePlace::name
};

/// An anchor that a controller names for a device; each entity with the controller must have it.
struct AnchorUse {
  std::string device;  ///< in words: "camera 'front'"
  std::string anchor;  ///< id of a link, "origin", or empty if it was a fault already
  Location where;
};

/// Something that a model or a controller needs and the scene does not have: a fault once an entity
/// uses the model or controller.
struct PendingFault {
  Location where;
  std::string text;
  std::vector<std::string_view> causes = {};  ///< as of Report::fault
};

/// Properties of a controller that matter when an entity uses it.
struct ControllerUse {
  bool has_actuators = false, has_sensors = false, has_params = false;
  std::vector<DeviceUse> devices;
  std::vector<AnchorUse> anchors;
  unsigned faults = 0;  ///< found with entities so far
  std::vector<PendingFault> missing_parts;
};

/// `<controller>` of an entity or a model, not yet looked up.
struct ControllerChoice {
  std::string id;
  PendingFault unknown;  ///< the fault if the scene has no such id
  std::optional<std::vector<std::pair<std::string, std::string>>> params;  ///< of <params> in it
  Location params_where;
};

/// Common part of the entities of a model.
struct Model {
  Entity entity;  ///< without id, pose and controller
  std::unordered_map<std::string, std::size_t> anchors;
  std::optional<ControllerChoice> controller;
  std::vector<PendingFault> missing_parts;
  std::size_t size = 0;            ///< as written [bytes]
  std::vector<std::string> names;  ///< of the attributes and children that its element may have
};

/// A scene while it is read.
struct Draft {
  Draft(Report& report_of_all, Scene& scene_read, const ReadOptions& chosen)
      : report(report_of_all),
        scene(scene_read),
        options(chosen),
        budget(budget_for(chosen.max_size)),
        set(chosen.variation.settings.size(), std::size_t{0}) {}

  Report& report;
  Scene& scene;
  const ReadOptions& options;
  ReadBudget budget;
  std::deque<Document> documents;  ///< of Scene::files, same order
  Parameters parameters;
  std::vector<Value<std::size_t>> set;  ///< per Variation::settings: how many attributes it has set
  std::vector<PendingFault>* missing_parts =
      nullptr;                ///< collects what the scene must provide; null: reported at once
  std::vector<Model> models;  ///< of Scene::models, same order
  std::unordered_map<std::string, std::size_t> model_ids;  ///< id -> index
  BodyDefaults defaults;
  bool has_engine = false;
  std::vector<ControllerUse> uses;                     ///< of Scene::controllers, same order
  std::unordered_map<std::string, std::size_t> media;  ///< id -> index
  bool may_add_media = true;  ///< of a scene: one that misses, if it is lenient
  std::unordered_map<std::string, std::size_t> controllers;  ///< id -> index
  std::set<Location> blamed;  ///< what entities have in common and is reported once already
  Ids entity_ids;
  std::uint64_t copies = 0;                              ///< of all <distribute> so far
  std::unordered_map<std::string, std::size_t> anchors;  ///< link id -> index, of the entity
                                                         ///< being read

  Document& add_document(std::string text, const std::string& name) {
    scene.files.push_back(name);
    Document& document =
        documents.emplace_back(std::move(text), scene.files.size() - 1, options.lenient, budget,
                               report, &parameters, options.vocabulary);
    const auto& settings = options.variation.settings;
    for (std::size_t i = 0; i < settings.size(); ++i) {
      std::size_t* const count = std::get_if<0>(&set[i]);
      if (!count) continue;
      auto more = document.set(settings[i]);
      if (std::get_if<1>(&more)) {
        set[i] = std::move(more);
      } else {
        *count += std::get<0>(more);
      }
    }
    return document;
  }
};

/// Parts of the scene from its included files and from itself, in the order of the includes.
struct Parts {
  std::vector<Element> models;       ///< each <models>
  std::vector<Element> controllers;  ///< each <controllers> of an included file
};

/// Reads all files that a file includes.
/// @param identity  of the scene's own file
Parts read_includes(Draft& draft, Element& root, const std::string& identity);

/// Why a file is refused: `is larger than …`.
std::string too_large(std::size_t max_size);

/// Reads <parameters> and what the command line gives for them.
void read_parameters(Draft& draft, Element& root);
void read_framework(Draft& draft, Element& root);
void read_engines(Draft& draft, Element& root);
void read_media(Draft& draft, Element& root);
void read_controllers(Draft& draft, Element& root, std::span<Element> included);
void read_directors(Draft& draft, Element& root);
void read_models(Draft& draft, Element& list);
void read_arena(Draft& draft, Element& root);

// --- controllers --------------------------------------------------------------------------------

/// Reads <actuators> and <sensors>.
void read_actuators(Draft& draft, Element& list, ControllerDevices& devices, ControllerUse& use);
void read_sensors(Draft& draft, Element& list, ControllerDevices& devices, ControllerUse& use);
/// The names of all devices that <actuators> and <sensors> may have.
std::vector<std::string_view> actuator_names();
std::vector<std::string_view> sensor_names();
std::vector<Camera> read_cameras(Draft& draft, Element& sensor, ControllerUse& use);

/// The last child of each name, in order of the names; earlier ones are reported as notices.
std::vector<Element> last_of_each_name(Element& list);

/// Reads what happens when a controller is late. An element with `deadline` replaces all of
/// `usual`, one without it keeps all of it.
std::optional<DeadlinePolicy> read_deadline(Element& element,
                                            const std::optional<DeadlinePolicy>& usual);

/// Reads `<controller>` of an entity or a model.
std::optional<ControllerChoice> read_controller_choice(Draft& draft, Element& element);

/// Gives an entity its controller.
void give_controller(Draft& draft, const ControllerChoice& choice, Entity& entity);
/// Checks that an entity has what its controller needs.
void check_use(Draft& draft, const Entity& entity);
/// The controller of an entity, or null.
const Controller* controller_of(const Draft& draft, const Entity& entity);

// --- entities -----------------------------------------------------------------------------------

/// Placement of an entity as written: in the arena, as the pattern of a <distribute>, or without a
/// place or id that counts.
enum class Placement { explicit_pose, distributed, looked_at };

/// Reads <box>, <cylinder>, <sphere>, <prototype>, <foot-bot>, <e-puck> or <light>.
Entity read_entity(Draft& draft, Element& element, Placement placement);
std::optional<EntityKind> entity_kind(std::string_view name);
/// The names of all kinds of entities, and others behind them.
std::vector<std::string_view> entity_names(std::initializer_list<std::string_view> others = {});
bool may_have_controller(EntityKind kind);

/// Reads what a model and an entity without a model have in common: all but id, pose and
/// controller.
void read_body_and_devices(Draft& draft, Element& element, Entity& entity);

/// Makes the entity one of the model of that name, with the controller of the model.
/// @returns where to write what can't stand on the entity itself
std::string apply_model(Draft& draft, Element& element, const std::string& name, Entity& entity,
                        std::optional<ControllerChoice>& controller);

/// Reports the missing parts, once.
void report_missing(Draft& draft, std::vector<PendingFault>& missing_parts);

/// Reads a <foot-bot> or <e-puck> into an entity whose kind is set.
void read_robot(Draft& draft, Element& element, Entity& entity);

void read_distribution(Draft& draft, Element& element);

/// `<body>` of an entity: its pose.
math::Pose read_body(Element& element, Placement placement);

/// `position` and `orientation` of any element, both optional.
math::Pose read_pose(Element& element);

/// Reads <links>; false if links can't be told apart or no reference link is known.
bool read_links(Draft& draft, Element& element, Entity& entity);

/// Reads <joints> and, if the tree is `rooted`, orders them from the root outwards.
void read_joints(Draft& draft, Element& element, Entity& entity, bool rooted);

/// Checks that joints make a tree with the reference link at its root, and orders them.
void order_joints(Report& report, Entity& entity);

/// Reads <devices> of a prototype.
void read_devices(Draft& draft, Element& element, Entity& entity);

/// Reads a <block>, which comes as it is.
void read_block(Draft& draft, Element& element, Entity& entity);

/// Reads <battery>.
Battery read_battery(Element& element);

/// Reads <leds> of a single body or prototype.
void read_leds(Draft& draft, Element& container, Entity& entity);

/// Reports that the id of an element is that of an earlier one.
/// @param what  has the id, for example "link"
void refuse_id(const Element& element, std::string_view what, Location earlier);
/// Takes the id of an element; a taken one is a fault, and false.
/// @param what  has the id, for example "link"
bool take_id(const Element& element, Ids& ids, const std::string& id, std::string_view what);

/// Takes the id of an entity or of what else the arena has, which is no director's either.
void take_entity_id(Draft& draft, const Element& element, const std::string& id);

/// Warns of angles in an attribute that look like radians.
void doubt_angles(Element& element, const char* attribute);

// --- shared values ------------------------------------------------------------------------------

/// Makes an entity immovable whose first link is heavier than anything that moves, with a notice.
/// @param where  of the mass
void stay(Report& report, Location where, Entity& entity, Link& link);

/// Reads `geometry` of a link with its extents.
Geometry read_geometry(Draft& draft, Element& link);

/// Reads the extents of a shape.
/// @param name  a known value of `geometry`
Geometry read_shape(Draft& draft, Element& element, std::string_view name);

/// `friction`, `rolling_friction`, `spinning_friction` and `restitution`.
Surface read_surface(Draft& draft, Element& element, const Surface& usual);

/// `linear_damping` and `angular_damping`.
Damping read_damping(Draft& draft, Element& element, const Damping& usual);

/// The medium that an attribute `medium` names; a missing, unknown or wrong one is a fault, or in
/// a model or an included controller a missing part.
std::optional<std::size_t> read_medium(Draft& draft, Element& element, MediumKind kind);

/// The anchor that an attribute `anchor` names; an unknown one is a fault.
Anchor read_anchor(Draft& draft, Element& element);

/// `origin`, then the links of the entity being read.
std::vector<std::string> anchor_names(const Draft& draft);

/// The names of all kinds of media.
std::span<const std::string_view> media_names();
/// The dialect's name of a kind of medium.
std::string_view to_string(MediumKind kind);

}  // namespace ziggurat::scene
