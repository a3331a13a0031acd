#pragma once
// A run from scene file to summary: what `run` and `serve` share.

#include "run/options.h"

namespace ziggurat::run {

enum class Service {
  run,    ///< starts the scene's controllers
  serve,  ///< waits for controllers from outside
};

/// @returns an exit code
/// @throws what main() turns into a message: faults of scene, arguments and environment
int execute(const Options& options, Service service);

}  // namespace ziggurat::run
