// SPDX-License-Identifier: MIT
#pragma once
// Options that must fit what the run is: its clients, its deadlines, its scene.

#include <span>
#include <string>
#include <vector>

#include "network/config.h"
#include "network/keys.h"
#include "reports/gate.h"
#include "run/options.h"
#include "scene/scene.h"
#include "world/layout.h"

namespace ziggurat::run {

struct ExpectedClients {
  bool can_connect = false;    ///< at an endpoint, or as programs that the run starts
  bool has_directors = false;  ///< of the scene, Lua scripts too
};

/// @param with_controllers  whether the run starts controllers and directors
ExpectedClients expected_clients(const Options& options, const scene::Scene& scene, bool is_serve,
                                 bool with_controllers);

/// @throws text::UsageError if an option is for what no client can ask for, or for drops where no
/// deadline drops
void check_client_options(const Options& options, const ExpectedClients& clients,
                          const network::Config& config);

/// Properties of the run that its gate depends on.
struct GateContext {
  std::span<const network::Config::Deadline> deadlines;  ///< of the controllers
  bool may_be_asked = false;  ///< clients of their own may ask for deadlines when they connect
  bool is_paced = false;
};

/// @throws text::UsageError if a condition of --gate is always met in this run
void check_gate(const std::vector<reports::Condition>& gate, const GateContext& context);

/// A sentence on each pattern of --curve-clients that limits a key to robots or controllers which
/// the scene does not have: it is misspelt, or for robots that are to be spawned.
std::vector<std::string> doubts_of(const std::vector<network::ClientKey>& clients,
                                   const scene::Scene& scene, const world::Layout& layout);

}  // namespace ziggurat::run
