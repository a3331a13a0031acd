#pragma once
// Who can ask a run for something, and the options that are only for what they ask.

#include "network/config.h"
#include "run/options.h"
#include "scene/scene.h"

namespace ziggurat::run {

struct Askers {
  bool clients = false;    ///< can connect: at an endpoint, or as programs that the run starts
  bool directors = false;  ///< of the scene, Lua scripts too
};

/// @param with_controllers  whether the run starts controllers and directors
Askers askers_of(const Options& options, const scene::Scene& scene, bool is_serve, bool with_controllers);

/// @throws text::UsageError if an option is for what no client can ask for, or for drops where no deadline drops
void check_askers(const Options& options, const Askers& askers, const network::Config& config);

}  // namespace ziggurat::run
