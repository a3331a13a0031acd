#pragma once
// Checks of the file of --curve-clients: its permissions decide who may connect, and its ids must
// fit the scene.

#include <sys/types.h>

#include <string>
#include <vector>

#include "network/keys.h"
#include "scene/scene.h"
#include "world/layout.h"

namespace ziggurat::run {

/// Checks that only root and the user who starts the program can change or replace the file. A file
/// that can't be read passes.
/// @param path  may be empty
/// @param user  user who starts the program
/// @throws text::UsageError
void check_clients(const std::string& path, uid_t user);

/// A sentence on each pattern that limits a key to robots or controllers which the scene does not
/// have: it is misspelt, or for robots that are to be spawned.
std::vector<std::string> doubts_of(const std::vector<network::ClientKey>& clients,
                                   const scene::Scene& scene, const world::Layout& layout);

}  // namespace ziggurat::run
