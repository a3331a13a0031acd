#pragma once
// Build of this program, as far as it may change results.

#include "recording/recorder/start.h"

namespace ziggurat::run {

recorder::Build this_build();

}  // namespace ziggurat::run
