// SPDX-License-Identifier: MIT
#pragma once
// --deadline [CONTROLLER=]ACTION[:MS[:BUDGET]]

#include <string>
#include <vector>

#include "network/server.h"
#include "scene/deadline.h"
#include "scene/scene.h"

namespace ziggurat::run {

struct DeadlineOption {
  std::string controller;  ///< id in the scene, or of a director; empty: all
  scene::DeadlinePolicy policy;
};

/// @throws text::UsageError
DeadlineOption to_deadline(const std::string& value);

struct DeadlinesOfRun {
  std::vector<network::Config::Deadline>
      all;                              ///< of the scene's controllers, then of its directors
  network::Config::Deadline of_others;  ///< of directors that the scene does not name
};

/// Later options win over earlier ones, those that name a controller or director over those for
/// all, and all of them over the scene.
/// @param otherwise  for those that neither the options nor the scene give one
/// @throws text::UsageError if the scene has none of that name
DeadlinesOfRun deadlines_of(const std::vector<DeadlineOption>& options, const scene::Scene& scene,
                            const scene::DeadlinePolicy& otherwise = {});

}  // namespace ziggurat::run
