#pragma once
// `ziggurat sweep status`, `results` and `plot`: what a folder of results has.

#include "cli/commands.h"

namespace ziggurat::cli {

/// Each gets the arguments behind its own name. @returns an exit code
int sweep_status(const Arguments& arguments);
int sweep_results(const Arguments& arguments);
int sweep_plot(const Arguments& arguments);

}  // namespace ziggurat::cli
