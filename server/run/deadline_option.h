#pragma once
// --deadline [CONTROLLER=]ACTION[:MS[:BUDGET]]

#include <string>
#include <vector>

#include "network/server.h"
#include "scene/deadline.h"
#include "scene/scene.h"

namespace ziggurat::run {

struct DeadlineOption {
  std::string controller;  ///< id in the scene; empty: all
  scene::DeadlinePolicy policy;
};

/// @throws text::UsageError
DeadlineOption to_deadline(const std::string& value);

/// For each controller of the scene. Later options win over earlier ones, those that name a
/// controller over those for all, and all of them over the scene.
/// @throws text::UsageError if the scene has no such controller
std::vector<network::Config::Deadline> deadlines_of(const std::vector<DeadlineOption>& options,
                                                    const scene::Scene& scene);

}  // namespace ziggurat::run
