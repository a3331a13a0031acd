#pragma once
// Patterns of --curve-clients, which must fit the scene.

#include <string>
#include <vector>

#include "network/keys.h"
#include "scene/scene.h"
#include "world/layout.h"

namespace ziggurat::run {

/// A sentence on each pattern that limits a key to robots or controllers which the scene does not
/// have: it is misspelt, or for robots that are to be spawned.
std::vector<std::string> doubts_of(const std::vector<network::ClientKey>& clients,
                                   const scene::Scene& scene, const world::Layout& layout);

}  // namespace ziggurat::run
