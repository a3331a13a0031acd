#pragma once
// The options --set and --param.

#include <string>
#include <vector>

#include "scene/variation.h"

namespace ziggurat::cli {

/// @param settings    of --set: `PATH=VALUE`
/// @param parameters  of --param: `NAME=VALUE`
/// @throws text::UsageError
scene::Variation to_variation(const std::vector<std::string>& settings,
                              const std::vector<std::string>& parameters);

}  // namespace ziggurat::cli
