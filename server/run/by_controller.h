#pragma once
// Options that may name a controller: `[CONTROLLER=]…`.

#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "scene/scene.h"
#include "text/numbers.h"

namespace ziggurat::run {

/// Calls apply(option, index of a controller) for every option and each controller that it applies
/// to: first for the options without a name, which apply to all, then for those with a name, each
/// in order.
/// @param name  of the option, for messages
/// @throws text::UsageError if the scene has no controller with that name
template <class Option, class Apply>
void apply_by_controller(std::string_view name, const std::vector<Option>& options,
                         const scene::Scene& scene, const Apply& apply) {
  for (const bool by_name : {false, true}) {
    for (const Option& option : options) {
      if (option.controller.empty() == by_name) continue;
      bool is_found = !by_name;
      for (std::size_t c = 0; c < scene.controllers.size(); ++c) {
        if (by_name && scene.controllers[c].id != option.controller) continue;
        apply(option, c);
        is_found = true;
      }
      if (!is_found) {
        throw text::UsageError(
            fmt::format("{}: the scene has no controller '{}'", name, option.controller));
      }
    }
  }
}

}  // namespace ziggurat::run
