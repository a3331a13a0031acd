// SPDX-License-Identifier: MIT
#pragma once
// Options that may name a controller, and some also a director: `[CONTROLLER=]…`.

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

/// Ids of all clients that a tick waits for: the scene's controllers, then its directors.
std::vector<std::string> ids_of_awaited(const scene::Scene& scene);

/// Indices of this id in ids_of_awaited(): a controller, a director, or one of each.
/// @throws text::UsageError with the ids that the scene has
std::vector<std::size_t> awaited_named(std::string_view option, const std::string& id,
                                       const scene::Scene& scene);

/// The command of `--controller ID=CMD`, of a controller or director; the script of a director is
/// not run then.
/// @throws as awaited_named(); text::UsageError if no shell could start the program
void set_command(scene::Scene& scene, const std::string& id, const std::string& command);

/// Calls apply(option) for every option: first for those without a name, which hold for all, then
/// for those with a name, each in order.
template <class Option, class Apply>
void apply_in_order(const std::vector<Option>& options, const Apply& apply) {
  for (const bool by_name : {false, true}) {
    for (const Option& option : options) {
      if (option.controller.empty() != by_name) apply(option);
    }
  }
}

/// Calls apply(option, index of a controller) for every option and each controller that it applies
/// to, in that order.
/// @param name  of the option, for messages
/// @throws text::UsageError if the scene has no controller with that name
template <class Option, class Apply>
void apply_by_controller(std::string_view name, const std::vector<Option>& options,
                         const scene::Scene& scene, const Apply& apply) {
  apply_in_order(options, [&](const Option& option) {
    if (!option.controller.empty()) {
      return apply(option, controller_named(name, option.controller, scene));
    }
    for (std::size_t c = 0; c < scene.controllers.size(); ++c) apply(option, c);
  });
}

/// The same for all clients that a tick waits for: apply(option, index into ids_of_awaited()).
template <class Option, class Apply>
void apply_by_awaited(std::string_view name, const std::vector<Option>& options,
                      const scene::Scene& scene, const Apply& apply) {
  const std::size_t count = scene.controllers.size() + scene.directors.size();
  apply_in_order(options, [&](const Option& option) {
    if (option.controller.empty()) {
      for (std::size_t i = 0; i < count; ++i) apply(option, i);
      return;
    }
    for (const std::size_t i : awaited_named(name, option.controller, scene)) apply(option, i);
  });
}

/// --restart [CONTROLLER=]N: controllers that died are started again.
struct RestartOption {
  std::string controller;  ///< id in the scene; empty: all
  unsigned times = 0;      ///< that each of its processes is started again at most
};

/// @throws text::UsageError
RestartOption to_restart(const std::string& value);

/// For each controller of the scene, how often each of its processes is started again at most.
/// Later options win over earlier ones, those that name a controller over those for all.
/// @throws text::UsageError if the scene has no such controller
std::vector<unsigned> restarts_of(const std::vector<RestartOption>& options,
                                  const scene::Scene& scene);

}  // namespace ziggurat::run
