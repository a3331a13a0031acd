// <models>: what many entities have in common, written once. Each is read once, and copied.

#include <array>

#include "scene/reading.h"

namespace ziggurat::scene {
namespace {

void refuse_what_entities_say(Element& element) {
  if (element.has("model")) {
    element.optional("model", identifier);
    element.fault_at("model",
                     "can't stand in a definition: models are not built on models; write "
                     "its parts into this one");
  }
  if (const auto body = element.child("body")) {
    body->fault("can't stand in a model: each of its entities has its own; remove it here");
  }
}

void take_id(Reading& reading, const Element& element, const std::string& id) {
  if (id.empty()) return;
  const auto [earlier, fresh] = reading.model_ids.emplace(id, reading.models.size());
  if (fresh) return;
  const Location where = reading.scene.models[earlier->second].where;
  element.fault_at("id", fmt::format("is the id of the model at {}; give each its own",
                                     reading.report.place(where)));
}

void read_model(Reading& reading, Element& element, EntityKind kind) {
  Model model;
  model.size = element.size();
  model.entity.kind = kind;
  const std::string id = element.required("id", identifier);
  reading.report.subject = fmt::format("model {}", in_quotes(id));
  refuse_what_entities_say(element);
  reading.lacks = &model.lacks;
  read_body_and_devices(reading, element, model.entity);
  reading.lacks = nullptr;
  if (may_have_controller(kind)) model.controller = read_controller_choice(reading, element);
  element.done();
  reading.report.subject.clear();
  take_id(reading, element, id);
  model.anchors = std::move(reading.anchors);
  reading.scene.models.push_back({id, element.where()});
  reading.models.push_back(std::move(model));
}

/// The index of a model for an element; a fault if there is none.
std::optional<std::size_t> find_model(const Reading& reading, const Element& element,
                                      const std::string& name) {
  const auto found = reading.model_ids.find(name);
  if (found == reading.model_ids.end()) {
    std::vector<std::string> known;
    for (const auto& model : reading.scene.models) known.push_back(model.id);
    element.fault_at("model",
                     known.empty()
                         ? "names no model; define it in <models>, or <include> a file that does"
                         : "names no model; " + advice(name, known));
    return std::nullopt;
  }
  const EntityKind kind = reading.models[found->second].entity.kind;
  if (kind == entity_kind(element.name())) return found->second;
  element.fault_at(
      "model", fmt::format("is a <{0}>, defined at {1}; write <{0} model={2} …>", to_string(kind),
                           reading.report.place(reading.scene.models[found->second].where),
                           in_quotes(name)));
  return std::nullopt;
}

/// Takes the model's size from the budget of the scene, as if it were written out; a fault, once, if
/// that is too small.
bool take_room(Reading& reading, const Element& element, std::size_t size) {
  if (size <= reading.budget.bytes) {
    reading.budget.bytes -= size;
    return true;
  }
  if (reading.blamed.insert(Location{}).second) {  // the whole scene is to blame
    element.fault(
        fmt::format("is one too many: with its models written out, the scene is larger "
                    "than {} bytes; use fewer, or raise --max-scene-size",
                    reading.options.max_size));
  }
  reading.budget.bytes = 0;
  return false;
}

void override_movable(Element& element, Entity& entity) {
  const auto movable = element.optional("movable", boolean);
  if (!movable || *movable == entity.movable) return;
  entity.movable = *movable;
  Link& root = entity.links[entity.reference_link];
  if (is_single(entity.kind) && !entity.movable) root.mass = 0;
  if (entity.movable && !(root.mass > 0)) {
    element.fault_at("movable",
                     "needs a mass, and the model has none; write movable=\"true\" and "
                     "the mass into the model, and movable=\"false\" on entities that must not move");
  }
}

}  // namespace

void read_models(Reading& reading, Element& list) {
  for (Element& element : list.children()) {
    if (const auto kind = entity_kind(element.name())) {
      read_model(reading, element, *kind);
    } else {
      element.unknown_in(list.name(), entity_names());
    }
  }
  list.done();
}

std::string apply_model(Reading& reading, Element& element, const std::string& name, Entity& entity,
                        std::optional<ControllerChoice>& controller) {
  const auto index = name.empty() ? std::nullopt : find_model(reading, element, name);
  if (!index) return "its model is unknown";
  Model& model = reading.models[*index];
  const std::string elsewhere =
      fmt::format("the model says it, at {}; an entity of it says id, model, movable, <body>{}",
                  reading.report.place(reading.scene.models[*index].where),
                  may_have_controller(entity.kind) ? " and <controller>" : "");
  if (!take_room(reading, element, model.size)) return elsewhere;
  report_lacks(reading, model.lacks);
  std::string id = std::move(entity.id);
  const Location where = entity.where;
  entity = model.entity;
  entity.id = std::move(id);
  entity.where = where;
  entity.model = *index;
  reading.anchors = model.anchors;
  controller = model.controller;
  if (!entity.links.empty()) override_movable(element, entity);
  return elsewhere;
}

}  // namespace ziggurat::scene
