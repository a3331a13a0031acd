// SPDX-License-Identifier: MIT
// <arena>: its volume, its entities, then its distributions.

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <variant>

#include "scene/additions.h"
#include "scene/draft.h"
#include "scene/files.h"

namespace ziggurat::scene {
namespace {

/// The picture of a floor: beside the scene's file, or as other versions have it in the working
/// folder.
std::variant<images::Image, std::string> open_picture(Draft& draft, const Element& element,
                                                      const std::string& written) {
  const std::filesystem::path name = written;
  if (!stays_inside(name)) {
    return "leads out of its folder; write a path without .. that is relative to the scene's file";
  }
  constexpr std::size_t most_bytes = std::size_t{64} << 20;
  const auto folder = folder_of(draft.scene, element.where());
  auto opened = draft.options.open(folder / name, most_bytes);
  if (std::holds_alternative<std::string>(opened)) {
    auto other = draft.options.open(name, most_bytes);
    if (std::holds_alternative<File>(other)) opened = std::move(other);
  }
  if (std::string* why = std::get_if<std::string>(&opened)) return std::move(*why);
  return images::read_image(std::get<File>(opened).text);
}

void read_picture(Draft& draft, Element& element) {
  const std::string name = element.required("path", path);
  if (name.empty()) return;
  auto picture = open_picture(draft, element, name);
  if (auto* image = std::get_if<images::Image>(&picture)) {
    draft.scene.floor_image = std::make_shared<const images::Image>(std::move(*image));
    return;
  }
  const std::string why =
      fmt::format("names {}, which {}", in_quotes(name), std::get<std::string>(picture));
  if (!draft.options.lenient) return element.fault_at("path", why);
  draft.report.notice(element.where("path"),
                      element.sentence("path", why) + "; the floor is white");
}

/// The coloured floor that ground sensors see; the floor that bodies stand on is the engine's.
void read_floor(Draft& draft, Element element, bool is_last) {
  const std::string id = element.required("id", identifier);
  const std::string source = element.required("source", Words{"image", "loop_functions"});
  if (!is_last) {
    draft.report.notice(element.where(), "this <floor> has no effect: a later one replaces it");
    element.without_effect("path", text, "a later <floor> replaces this one");
  } else if (source == "image") {
    read_picture(draft, element);
  } else if (source == "loop_functions") {
    draft.report.notice(element.where("source"),
                        "<floor source=\"loop_functions\"> is white: no library is loaded that "
                        "would colour it");
  }
  element.optional("pixels_per_meter", In{"1/m", positive});
  take_entity_id(draft, element, id);
  element.done();
}

void add_entity(Draft& draft, Element& element) {
  Entity entity = read_entity(draft, element, Placement::explicit_pose);
  take_entity_id(draft, element, entity.id);
  draft.scene.entities.push_back(std::move(entity));
}

void read_placed(Draft& draft, Element& element, bool is_last_floor) {
  if (entity_kind(element.name())) {
    add_entity(draft, element);
  } else if (element.name() == "floor") {
    read_floor(draft, element, is_last_floor);
  } else if (element.name() != "distribute") {
    element.unknown_in("arena", entity_names({"floor", "distribute"}));
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
  const auto last_floor =
      std::ranges::find(children.rbegin(), children.rend(), "floor", &Element::name);
  for (Element& element : children) {
    read_placed(draft, element, last_floor != children.rend() && &element == &*last_floor);
  }
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
