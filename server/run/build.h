#pragma once
// What this program was built with, as far as it may change results.

#include "recorder/start.h"

namespace ziggurat::run {

recorder::Build this_build();

}  // namespace ziggurat::run
