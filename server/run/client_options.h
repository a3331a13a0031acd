#pragma once
// Clients that a run can have, and the options that only such clients use.

#include "network/config.h"
#include "run/options.h"
#include "scene/scene.h"

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

}  // namespace ziggurat::run
