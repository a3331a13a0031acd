// SPDX-License-Identifier: MIT
#include "scene/additions.h"

#include <algorithm>
#include <array>

#include "scene/draft.h"

namespace ziggurat::scene {
namespace {

constexpr const char* name_of_additions = "spawn";
constexpr std::size_t most_attributes_added = 1000;  // of an element that is added
constexpr std::size_t most_faults_of_addition = 20;  // it is read while the world waits

void check_addition(Draft& draft, const Element& element, const Entity& entity,
                    const std::function<bool(const std::string&)>& is_taken) {
  if (!entity.id.empty() && is_taken(entity.id)) {
    element.fault_at("id", "is the id of another entity; give each its own");
  }
  if (!draft.has_engine) {
    element.fault(
        "needs an engine, and the scene has none; write <dynamics3d id=\"…\"/> into its "
        "<physics_engines>");
  }
}

}  // namespace

struct Additions::Parts {
  ReadOptions options;
  BodyDefaults defaults;
  bool has_engine = false;
  std::vector<Model> models;
  std::unordered_map<std::string, std::size_t> model_ids;
  std::vector<ControllerUse> uses;
  std::unordered_map<std::string, std::size_t> media, controllers;
  Parameters parameters;
};

Additions::Additions() = default;
Additions::Additions(Draft& draft)
    : parts_(std::make_unique<Parts>(
          Parts{draft.options, draft.defaults, draft.has_engine, std::move(draft.models),
                std::move(draft.model_ids), std::move(draft.uses), std::move(draft.media),
                std::move(draft.controllers), std::move(draft.parameters)})) {}
Additions::~Additions() = default;
Additions::Additions(Additions&&) noexcept = default;
Additions& Additions::operator=(Additions&&) noexcept = default;

bool Addition::ok() const {
  return std::ranges::none_of(problems, [](const Problem& problem) {
    return problem.severity == Problem::Severity::fault;
  });
}

Addition Additions::read(std::string text, const Scene& scene, std::size_t max_size,
                         const std::function<bool(const std::string&)>& is_taken,
                         const OpenFile& open) const {
  return read_element(std::move(text), scene, max_size, open,
                      [&](Draft& draft, Element& element, Entity& entity) {
                        entity = read_entity(draft, element, Placement::explicit_pose);
                        check_addition(draft, element, entity, is_taken);
                      });
}

Addition Additions::read_shape(std::string text, const Scene& scene, std::size_t max_size,
                               const OpenFile& open) const {
  return read_element(
      std::move(text), scene, max_size, open, [&](Draft& draft, Element& element, Entity& entity) {
        const EntityKind kind = *entity_kind(element.name());
        if (is_single(kind) && kind != EntityKind::light && !element.has("model")) {
          entity.kind = kind;
          entity.links.emplace_back().geometry = scene::read_shape(draft, element, element.name());
        } else {
          entity = read_entity(draft, element, Placement::looked_at);
        }
      });
}

Addition Additions::read_element(std::string text, const Scene& scene, std::size_t max_size,
                                 const OpenFile& open,
                                 const std::function<void(Draft&, Element&, Entity&)>& read) const {
  Addition addition;
  // A copy, because models and controllers note which of their faults have been reported.
  Scene around;
  around.files = scene.files;
  around.controllers = scene.controllers;
  around.models = scene.models;
  around.physics = scene.physics;
  around.media = scene.media;
  Report report(around.files, most_faults_of_addition);
  if (text.size() > max_size) {
    addition.problems = {
        {Problem::Severity::fault, name_of_additions, {}, "the file " + too_large(max_size)}};
    return addition;
  }
  if (text.find('<') == text.npos) {
    addition.problems = {
        {Problem::Severity::fault,
         name_of_additions,
         {},
         "there is no element; write one, such as <box id=\"b\" size=\".1,.1,.1\" movable=\"true\" "
         "mass=\"1\"><body position=\"0,0,1\"/></box>"}};
    return addition;
  }
  ReadOptions options = parts_->options;
  options.open = open;
  options.variation = {};  // it was for the scene
  Draft draft(report, around, options);
  draft.budget = budget_for(max_size);
  draft.budget.attributes = most_attributes_added;
  draft.defaults = parts_->defaults;
  draft.has_engine = parts_->has_engine;
  draft.models = parts_->models;
  draft.model_ids = parts_->model_ids;
  draft.uses = parts_->uses;
  draft.media = parts_->media;
  draft.may_add_media = false;
  draft.controllers = parts_->controllers;
  draft.parameters = parts_->parameters;
  try {
    Document& document = draft.add_document(std::move(text), name_of_additions);
    if (document.root()) {
      Element element(document, document.root());
      if (entity_kind(element.name())) {
        read(draft, element, addition.entity);
      } else {
        element.unknown_in("spawn", entity_names());
      }
    }
  } catch (const TooManyFaults&) {
    // The last fault says so.
  }
  addition.problems = report.problems();
  addition.size = max_size - draft.budget.bytes;
  return addition;
}

std::function<Entity(const std::string& xml)> reader_of_spawned(const Additions& additions,
                                                                const Scene& scene, OpenFile open) {
  constexpr std::size_t most = std::size_t{64} << 20;  // [bytes]
  return [&additions, &scene, open = std::move(open), left = most](const std::string& xml) mutable {
    Addition addition = additions.read(
        xml, scene, left, [](const std::string&) { return false; }, open);
    if (!addition.ok()) throw SceneError(std::move(addition.problems));
    left -= addition.size;
    return std::move(addition.entity);
  };
}

std::filesystem::path folder_of(const Scene& scene, const Location& where) {
  const std::string file = file_of(scene, where);
  const bool is_added = file == name_of_additions && !scene.files.empty();
  return std::filesystem::path(is_added ? scene.files.front() : file).parent_path();
}

std::string file_of(const Scene& scene, const Location& where) {
  return where.file < scene.files.size() ? scene.files[where.file] : name_of_additions;
}

}  // namespace ziggurat::scene
