// SPDX-License-Identifier: MIT
#pragma once
// --inject [CONTROLLER=][observations:|commands:]latency=TIME,jitter=TIME,loss=SHARE

#include <optional>
#include <string>
#include <vector>

#include "network/delays.h"
#include "network/server.h"
#include "scene/scene.h"

namespace ziggurat::run {

struct InjectOption {
  std::string controller;                       ///< id in the scene, or of a director; empty: all
  std::optional<network::Direction> direction;  ///< nothing: both
  network::Disturbance disturbance;
};

/// @throws text::UsageError with the reason and an example
InjectOption to_injection(const std::string& value);

/// For each controller of the scene, then for each of its directors. Later options win over earlier
/// ones, and those with a name over those for all; each sets all three values of its direction.
/// @throws text::UsageError if the scene has none of that name
std::vector<network::Injection> injections_of(const std::vector<InjectOption>& options,
                                              const scene::Scene& scene);

/// @param deadlines  of the same
/// @throws text::UsageError if messages are lost that the world would wait for forever
void check_losses(const std::vector<network::Injection>& injections, const scene::Scene& scene,
                  const std::vector<network::Config::Deadline>& deadlines);

}  // namespace ziggurat::run
