// <media>: what devices are seen and heard in.

#include <array>

#include "scene/reading.h"

namespace ziggurat::scene {
namespace {

constexpr std::array<std::string_view, 5> medium_names{"led", "directional_led", "tag", "radio",
                                                       "range_and_bearing"};

std::optional<MediumKind> kind_of(std::string_view name) {
  for (std::size_t i = 0; i < medium_names.size(); ++i) {
    if (medium_names[i] == name) return static_cast<MediumKind>(i);
  }
  return std::nullopt;
}

void read_medium_element(Reading& reading, Element& element, MediumKind kind) {
  Medium medium{element.required("id", identifier), kind, true, element.where()};
  element.optional("index", Words{"grid"});
  element.without_effect("grid_size", cells, "media need no grid, and devices may leave the arena");
  if (kind == MediumKind::range_and_bearing) {
    medium.checks_occlusions = element.optional("check_occlusions", boolean, true);
  }
  element.done();
  if (medium.id.empty()) return;
  if (!reading.media.emplace(medium.id, reading.scene.media.size()).second) {
    element.fault_at("id", "is the id of an earlier medium; give each its own");
    return;
  }
  reading.scene.media.push_back(std::move(medium));
}

}  // namespace

std::string_view to_string(MediumKind kind) { return medium_names[static_cast<std::size_t>(kind)]; }

void read_media(Reading& reading, Element& root) {
  auto media = root.required_child("media");
  if (!media) return;
  for (Element& element : media->children()) {
    if (const auto kind = kind_of(element.name())) {
      read_medium_element(reading, element, *kind);
    } else {
      element.unknown_in(media->name(), medium_names);
    }
  }
  media->done();
}

std::optional<std::size_t> read_medium(Reading& reading, Element& element, MediumKind kind) {
  const std::string id = element.required("medium", identifier);
  if (id.empty()) return std::nullopt;
  const auto found = reading.media.find(id);
  const auto lack = [&](std::string_view text) {
    if (!reading.lacks) return element.fault_at("medium", text);
    reading.lacks->push_back({element.where("medium"), element.sentence("medium", text)});
  };
  if (found == reading.media.end()) {
    std::vector<std::string> candidates;
    for (const Medium& medium : reading.scene.media) {
      if (medium.kind == kind) candidates.push_back(medium.id);
    }
    lack(candidates.empty() || reading.lacks
             ? fmt::format("names no medium{}; write <{} id={}/> in <media>",
                           reading.lacks ? " of the scene" : "", to_string(kind), in_quotes(id))
             : "names no medium; " + advice(id, candidates));
    return std::nullopt;
  }
  const MediumKind is = reading.scene.media[found->second].kind;
  if (is != kind) {
    lack(fmt::format("names a medium of type {}; name a {} medium", to_string(is),
                     to_string(kind)));
    return std::nullopt;
  }
  return found->second;
}

}  // namespace ziggurat::scene
