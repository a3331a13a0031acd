// <arena>: its volume, its entities, then its distributions.

#include <array>

#include "scene/draft.h"

namespace ziggurat::scene {
namespace {

/// The coloured floor that ground sensors see; the floor that bodies stand on is the engine's.
void read_ground(Draft& draft, Element element) {
  draft.report.no_effect_yet(element.where(), "ground colours (<floor> of the arena)");
  const std::string id = element.required("id", identifier);
  const std::string source = element.required("source", Words{"image", "loop_functions"});
  if (source == "image") element.required("path", path);
  if (source == "loop_functions" && draft.options.lenient) {
    draft.report.notice(
        element.where("source"),
        "<floor source=\"loop_functions\"> is white here: what a library would draw is not drawn");
  } else if (source == "loop_functions") {
    element.fault_at(
        "source",
        "is not supported: libraries are not loaded into the server; write source=\"image\" "
        "and a path, or run with --lenient, which makes the floor white");
  }
  element.optional("pixels_per_meter", positive);
  take_entity_id(draft, element, id);
  element.done();
}

void add_entity(Draft& draft, Element& element) {
  Entity entity = read_entity(draft, element, Placement::explicit_pose);
  take_entity_id(draft, element, entity.id);
  draft.scene.entities.push_back(std::move(entity));
}

void read_placed(Draft& draft, Element& element) {
  if (entity_kind(element.name())) {
    add_entity(draft, element);
  } else if (element.name() == "light") {
    const std::string id = read_light(draft, element, Placement::explicit_pose);
    take_entity_id(draft, element, id);
  } else if (element.name() == "floor") {
    read_ground(draft, element);
  } else if (element.name() != "distribute") {
    element.unknown_in("arena", entity_names({"light", "floor", "distribute"}));
  }
}

}  // namespace

void read_arena(Draft& draft, Element& root) {
  auto arena = root.required_child("arena");
  if (!arena) return;
  draft.scene.arena.size = arena->required("size", room, math::Vector3::Ones());
  if (draft.scene.arena.size.z() == 0) {
    draft.report.notice(arena->where("size"),
                        "an <arena> of height 0 is a flat world, without a ceiling");
  }
  draft.scene.arena.center = arena->optional("center", position, math::Vector3::Zero());
  std::vector<Element> children = arena->children();
  for (Element& element : children) read_placed(draft, element);
  for (Element& element : children) {
    if (element.name() == "distribute") read_distribution(draft, element);
  }
  arena->done();
  const Scene& scene = draft.scene;
  if (!draft.has_engine && !(scene.entities.empty() && scene.distributions.empty())) {
    arena->fault(
        "has entities, but <physics_engines> has no engine; write "
        "<dynamics3d id=\"…\"/> in it",
        {"physics_engines", "dynamics3d", "dynamics2d", "pointmass3d"});
  }
}

}  // namespace ziggurat::scene
