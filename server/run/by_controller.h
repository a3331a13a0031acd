#pragma once
// Options that may name a controller: `[CONTROLLER=]…`.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace ziggurat::run {

/// The index of the scene's controller with this id.
/// @param option  its name, for messages
/// @throws text::UsageError with the ids that the scene has
std::size_t controller_named(std::string_view option, const std::string& id,
                             const scene::Scene& scene);

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
      if (by_name) {
        apply(option, controller_named(name, option.controller, scene));
      } else {
        for (std::size_t c = 0; c < scene.controllers.size(); ++c) apply(option, c);
      }
    }
  }
}

}  // namespace ziggurat::run
