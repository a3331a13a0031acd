#pragma once
// `ziggurat sweep` on clusters: what is submitted, and a task of it.

#include "cli/commands.h"
#include "cli/sweep_options.h"

namespace ziggurat::cli {

/// Submits the runs that have no result yet. @returns an exit code
int submit_sweep(const SweepOptions& options);

/// `ziggurat sweep task DIR`: the runs of one task that have no result yet.
/// @returns an exit code: 0 also if runs failed, because that is a result
int sweep_task(const Arguments& arguments, processes::Signals& signals);

}  // namespace ziggurat::cli
