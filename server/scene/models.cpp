// SPDX-License-Identifier: MIT
// <models>: what many entities have in common, written once. Each is read once, and copied.

#include <algorithm>
#include <array>

#include "scene/draft.h"
#include "scene/memory.h"

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

void take_id(Draft& draft, const Element& element, const std::string& id) {
  if (id.empty()) return;
  const auto [earlier, fresh] = draft.model_ids.emplace(id, draft.models.size());
  if (fresh) return;
  refuse_id(element, "model", draft.scene.models[earlier->second].where);
}

void read_model(Draft& draft, Element& element, EntityKind kind) {
  Model model;
  model.size = element.size();
  model.entity.kind = kind;
  const std::string id = element.required("id", identifier);
  draft.report.subject = fmt::format("model {}", in_quotes(id));
  refuse_what_entities_say(element);
  draft.missing_parts = &model.missing_parts;
  read_body_and_devices(draft, element, model.entity);
  draft.missing_parts = nullptr;
  if (may_have_controller(kind)) model.controller = read_controller_choice(draft, element);
  model.names = element.asked();
  element.done();
  take_memory(draft, element, memory_of(model.entity, nullptr), model.size);
  draft.report.subject.clear();
  take_id(draft, element, id);
  model.anchors = std::move(draft.anchors);
  draft.scene.models.push_back({id, element.where(), kind});
  draft.models.push_back(std::move(model));
}

/// The index of a model for an element; a fault if there is none.
std::optional<std::size_t> find_model(const Draft& draft, const Element& element,
                                      const std::string& name) {
  const auto found = draft.model_ids.find(name);
  if (found == draft.model_ids.end()) {
    std::vector<std::string> known;
    const auto& all = draft.scene.models;
    for (std::size_t i = 0; i < std::min(all.size(), most_compared); ++i)
      known.push_back(all[i].id);
    element.fault_at("model",
                     known.empty()
                         ? "names no model; define it in <models>, or <include> a file that does"
                         : "names no model; " + draft.report.advice(name, known),
                     {"models", "include", "id", element.name()});
    return std::nullopt;
  }
  const EntityKind kind = draft.models[found->second].entity.kind;
  if (kind == entity_kind(element.name())) return found->second;
  element.fault_at(
      "model",
      fmt::format("is a <{0}>, defined at {1}; write <{0} model={2} …>", to_string(kind),
                  draft.report.place(draft.scene.models[found->second].where), in_quotes(name)));
  return std::nullopt;
}

/// Takes the model's size from the budget of the scene, as if it were written out; a fault, once,
/// if that is too small.
bool take_size(Draft& draft, const Element& element, std::size_t size) {
  if (size <= draft.budget.bytes) {
    draft.budget.bytes -= size;
    return true;
  }
  if (draft.blamed.insert(Location{}).second) {  // the whole scene is to blame
    element.fault(
        fmt::format("is one too many: with its models written out, the scene is larger "
                    "than {} bytes; use fewer, or raise --max-scene-size",
                    draft.options.max_size));
  }
  draft.budget.bytes = 0;
  return false;
}

void override_movable(Element& element, Entity& entity) {
  const auto movable = element.optional("movable", boolean);
  if (!movable || *movable == entity.movable) return;
  entity.movable = *movable;
  Link& root = entity.links[entity.reference_link];
  if (is_single(entity.kind) && !entity.movable) root.mass = 0;
  if (entity.movable && !(root.mass > 0)) {
    element.fault_at(
        "movable",
        "needs a mass, and the model has none; write movable=\"true\" and "
        "the mass into the model, and movable=\"false\" on entities that must not move");
  }
}

}  // namespace

void read_models(Draft& draft, Element& list) {
  for (Element& element : list.children()) {
    if (const auto kind = entity_kind(element.name())) {
      read_model(draft, element, *kind);
    } else {
      element.unknown_in(list.name(), entity_names());
    }
  }
  list.done();
}

std::string apply_model(Draft& draft, Element& element, const std::string& name, Entity& entity,
                        std::optional<ControllerChoice>& controller) {
  const auto index = name.empty() ? std::nullopt : find_model(draft, element, name);
  if (!index) {
    for (const char* part : {"links", "devices"}) draft.report.left_out(part);
    return "its model is unknown";
  }
  Model& model = draft.models[*index];
  const std::string elsewhere =
      fmt::format("the model has it, at {}; with a model write only id, model, movable, <body>{}",
                  draft.report.place(draft.scene.models[*index].where),
                  may_have_controller(entity.kind) ? " and <controller>" : "");
  if (!take_size(draft, element, model.size)) return elsewhere;
  report_missing(draft, model.missing_parts);
  std::string id = std::move(entity.id);
  const Location where = entity.where;
  entity = model.entity;
  entity.id = std::move(id);
  entity.where = where;
  entity.model = *index;
  draft.anchors = model.anchors;
  controller = model.controller;
  if (!entity.links.empty()) override_movable(element, entity);
  return elsewhere;
}

}  // namespace ziggurat::scene
