// SPDX-License-Identifier: MIT
#pragma once
// Version of this program, and its build as far as it may change results.

#include "recording/recorder/start.h"

namespace ziggurat::run {

inline constexpr const char* version = ZIGGURAT_VERSION;

recorder::Build this_build();

}  // namespace ziggurat::run
