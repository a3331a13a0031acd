#include "run/by_controller.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "text/names.h"
#include "text/numbers.h"

namespace ziggurat::run {

std::size_t controller_named(std::string_view option, const std::string& id,
                             const scene::Scene& scene) {
  std::vector<std::string> ids;
  for (const scene::Controller& controller : scene.controllers) {
    if (controller.id == id) return ids.size();
    ids.push_back(controller.id);
  }
  const std::string known =
      ids.empty() ? "it has none" : fmt::format("it has: {}", fmt::join(ids, ", "));
  throw text::UsageError(fmt::format("{}: the scene has no controller '{}'; {}", option, id,
                                     text::advice(id, ids, known)));
}

std::vector<std::string> ids_of_awaited(const scene::Scene& scene) {
  std::vector<std::string> ids;
  for (const scene::Controller& controller : scene.controllers) ids.push_back(controller.id);
  for (const scene::Director& director : scene.directors) ids.push_back(director.id);
  return ids;
}

std::vector<std::size_t> awaited_named(std::string_view option, const std::string& id,
                                       const scene::Scene& scene) {
  const std::vector<std::string> ids = ids_of_awaited(scene);
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (ids[i] == id) places.push_back(i);
  }
  if (!places.empty()) return places;
  const std::string known =
      ids.empty() ? "it has none" : fmt::format("it has: {}", fmt::join(ids, ", "));
  throw text::UsageError(fmt::format("{}: the scene has no controller or director '{}'; {}", option, id,
                                     text::advice(id, ids, known)));
}

}  // namespace ziggurat::run
