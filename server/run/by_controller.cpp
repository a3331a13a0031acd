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

}  // namespace ziggurat::run
