#pragma once
// --restart [CONTROLLER=]N: controllers that died are started again.

#include <string>
#include <vector>

#include "scene/scene.h"

namespace ziggurat::run {

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
