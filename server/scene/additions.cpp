#include "scene/additions.h"

#include <algorithm>
#include <array>

#include "scene/document.h"
#include "scene/reading.h"

namespace ziggurat::scene {
namespace {

constexpr const char* name_of_additions = "spawn";

void read_addition(Reading& reading, std::string text,
                   const std::function<bool(const std::string&)>& is_taken, Entity& entity) {
  Document& document = reading.add_document(std::move(text), name_of_additions);
  if (!document.root()) return;
  Element element(document, document.root());
  if (!entity_kind(element.name())) return element.unknown_in("spawn", entity_names());
  entity = read_entity(reading, element, Placement::explicit_pose);
  if (!entity.id.empty() && is_taken(entity.id)) {
    element.fault_at("id", "is the id of another entity; give each its own");
  }
  if (!reading.has_engine) element.fault("needs an engine, and the scene has none");
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
};

Additions::Additions() = default;
Additions::Additions(Reading& reading)
    : parts_(std::make_unique<Parts>(Parts{reading.options, reading.defaults, reading.has_engine,
                                           std::move(reading.models), std::move(reading.model_ids),
                                           std::move(reading.uses), std::move(reading.media),
                                           std::move(reading.controllers)})) {}
Additions::~Additions() = default;
Additions::Additions(Additions&&) noexcept = default;
Additions& Additions::operator=(Additions&&) noexcept = default;

bool Addition::ok() const {
  return std::ranges::none_of(problems, [](const Problem& problem) {
    return problem.severity == Problem::Severity::fault;
  });
}

Addition Additions::read(std::string text, const Scene& scene, std::size_t room,
                         const std::function<bool(const std::string&)>& is_taken) const {
  Addition addition;
  // A copy: what a reading finds wrong with models and controllers, it notes there as said.
  Scene around;
  around.files = scene.files;
  around.controllers = scene.controllers;
  around.models = scene.models;
  around.physics = scene.physics;
  around.media = scene.media;
  Report report(around.files);
  if (text.size() > room) {
    addition.problems = {
        {Problem::Severity::fault, name_of_additions, {}, "the file " + too_large(room)}};
    return addition;
  }
  Reading reading(report, around, parts_->options);
  reading.budget = budget_for(room);
  reading.defaults = parts_->defaults;
  reading.has_engine = parts_->has_engine;
  reading.models = parts_->models;
  reading.model_ids = parts_->model_ids;
  reading.uses = parts_->uses;
  reading.media = parts_->media;
  reading.controllers = parts_->controllers;
  try {
    read_addition(reading, std::move(text), is_taken, addition.entity);
  } catch (const TooManyFaults&) {
    // The last fault says so.
  }
  addition.problems = report.problems();
  addition.size = room - reading.budget.bytes;
  return addition;
}

std::string file_of(const Scene& scene, const Location& where) {
  return where.file < scene.files.size() ? scene.files[where.file] : name_of_additions;
}

}  // namespace ziggurat::scene
