// SPDX-License-Identifier: MIT
// <media>: which devices can perceive each other.

#include <array>

#include "scene/draft.h"
#include "scene/robots/robots.h"

namespace ziggurat::scene {
namespace {

constexpr std::array<std::string_view, 6> medium_names{
    "led", "directional_led", "tag", "radio", "range_and_bearing", "kilobot_communication"};

std::optional<MediumKind> kind_of(std::string_view name) {
  for (std::size_t i = 0; i < medium_names.size(); ++i) {
    if (medium_names[i] == name) return static_cast<MediumKind>(i);
  }
  return std::nullopt;
}

void read_medium_element(Draft& draft, Element& element, MediumKind kind) {
  Medium medium{.id = element.required("id", identifier), .kind = kind, .where = element.where()};
  if (draft.options.lenient) {
    element.without_effect("index", text, "devices are found by their place anyway");
  } else {
    element.optional("index", Words{"grid"});
  }
  element.without_effect("grid_size", cells, "media need no grid, and devices may leave the arena");
  if (kind == MediumKind::range_and_bearing) {
    medium.checks_occlusions = element.optional("check_occlusions", boolean, true);
  }
  element.done();
  if (medium.id.empty()) return;
  const auto [earlier, fresh] = draft.media.emplace(medium.id, draft.scene.media.size());
  if (!fresh) return refuse_id(element, "medium", draft.scene.media[earlier->second].where);
  draft.scene.media.push_back(std::move(medium));
}

}  // namespace

std::span<const std::string_view> media_names() { return medium_names; }

std::string_view to_string(MediumKind kind) { return medium_names[static_cast<std::size_t>(kind)]; }

void read_media(Draft& draft, Element& root) {
  auto media = draft.options.lenient ? root.child("media") : root.required_child("media");
  if (!media) return;
  for (Element& element : media->children()) {
    if (const auto kind = kind_of(element.name())) {
      read_medium_element(draft, element, *kind);
    } else {
      element.unknown_in(media->name(), medium_names);
    }
  }
  media->done();
}

namespace {

/// For a lenient scene that names no medium that is there: the first of its type, or a new one.
std::size_t stand_in(Draft& draft, Element& element, MediumKind kind) {
  std::string id = element.optional("medium", text, std::string());
  draft.report.notice(
      element.where(),
      fmt::format("<{}> names no medium of type {} that is there: the first one, or "
                  "a new one, counts",
                  element.name(), to_string(kind)));
  if (const auto first = first_medium(draft.scene, kind)) return *first;
  if (id.empty()) id = to_string(kind);
  while (draft.media.contains(id)) id += '_';
  draft.media.emplace(id, draft.scene.media.size());
  draft.scene.media.push_back({.id = id, .kind = kind, .where = element.where()});
  return draft.scene.media.size() - 1;
}

/// Whether an element names a medium that is there.
bool names_medium(const Draft& draft, const Element& element, MediumKind kind) {
  const auto found = draft.media.find(std::string(written(element, "medium")));
  return found != draft.media.end() && draft.scene.media[found->second].kind == kind;
}

}  // namespace

std::optional<std::size_t> read_medium(Draft& draft, Element& element, MediumKind kind) {
  const bool may_stand_in = draft.options.lenient && !draft.missing_parts &&
                            (draft.may_add_media || first_medium(draft.scene, kind));
  if (may_stand_in && !names_medium(draft, element, kind)) return stand_in(draft, element, kind);
  const std::string id = element.required("medium", identifier);
  if (id.empty()) return std::nullopt;
  const auto found = draft.media.find(id);
  const auto fault = [&](std::string_view text) {
    std::vector<std::string_view> causes{"media", to_string(kind), "id"};
    if (!draft.missing_parts) return element.fault_at("medium", text, std::move(causes));
    draft.missing_parts->push_back(
        {element.where("medium"), element.sentence("medium", text), std::move(causes)});
  };
  if (found == draft.media.end()) {
    std::vector<std::string> candidates;
    for (const Medium& medium : draft.scene.media) {
      if (medium.kind == kind && candidates.size() < most_compared) candidates.push_back(medium.id);
    }
    fault(candidates.empty() || draft.missing_parts
              ? fmt::format("names no medium{}; write <{} id={}/> in <media>",
                            draft.missing_parts ? " of the scene" : "", to_string(kind),
                            in_quotes(id))
              : "names no medium; " + draft.report.advice(id, candidates));
    return std::nullopt;
  }
  const MediumKind is = draft.scene.media[found->second].kind;
  if (is != kind) {
    fault(
        fmt::format("names a medium of type {}; name a {} medium", to_string(is), to_string(kind)));
    return std::nullopt;
  }
  return found->second;
}

}  // namespace ziggurat::scene
