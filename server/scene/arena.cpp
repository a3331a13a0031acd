// <arena>: its volume, then what stands in it, then what is distributed over it.

#include <array>

#include "scene/reading.h"

namespace ziggurat::scene {
namespace {

/// The coloured floor that ground sensors see; the floor that bodies stand on is the engine's.
void read_ground(Reading& reading, Element element) {
  reading.report.no_effect_yet(element.where(), "ground colours (<floor> of the arena)");
  const std::string id = element.required("id", identifier);
  const std::string source = element.required("source", Words{"image", "loop_functions"});
  if (source == "image") element.required("path", path);
  if (source == "loop_functions") {
    element.fault_at("source", "is not supported; write source=\"image\" and a path");
  }
  element.optional("pixels_per_meter", positive);
  if (!id.empty() && !reading.entity_ids.add(id)) {
    element.fault_at("id", "is the id of an earlier entity; give each its own");
  }
  element.done();
}

void add_entity(Reading& reading, Element& element) {
  Entity entity = read_entity(reading, element, Placement::explicit_pose);
  if (!entity.id.empty() && !reading.entity_ids.add(entity.id)) {
    element.fault_at("id", "is the id of an earlier entity; give each its own");
  }
  reading.scene.entities.push_back(std::move(entity));
}

void read_placed(Reading& reading, Element& element) {
  if (entity_kind(element.name())) {
    add_entity(reading, element);
  } else if (element.name() == "light") {
    const std::string id = read_light(reading, element, Placement::explicit_pose);
    if (!id.empty() && !reading.entity_ids.add(id)) {
      element.fault_at("id", "is the id of an earlier entity; give each its own");
    }
  } else if (element.name() == "floor") {
    read_ground(reading, element);
  } else if (element.name() != "distribute") {
    element.unknown_in("arena", entity_names({"light", "floor", "distribute"}));
  }
}

}  // namespace

void read_arena(Reading& reading, Element& root) {
  auto arena = root.required_child("arena");
  if (!arena) return;
  reading.scene.arena.size = arena->required("size", size, math::Vector3::Ones());
  reading.scene.arena.center = arena->optional("center", position, math::Vector3::Zero());
  std::vector<Element> children = arena->children();
  for (Element& element : children) read_placed(reading, element);
  for (Element& element : children) {
    if (element.name() == "distribute") read_distribution(reading, element);
  }
  arena->done();
  const Scene& scene = reading.scene;
  if (!reading.has_engine && !(scene.entities.empty() && scene.distributions.empty())) {
    arena->fault(
        "has entities, but <physics_engines> has no engine; write "
        "<dynamics3d id=\"…\"/> in it");
  }
}

}  // namespace ziggurat::scene
