#pragma once
// What a robot shows and others perceive: LEDs, directional LEDs, tags, magnets, and the data that
// range-and-bearing devices send. Commands of tick k are in State k + 1.

#include "devices/tick.h"

namespace ziggurat::devices {

/// What the scene says of those that are new, in commands and state.
void start_visible(Tick& tick);
void apply_visible(Tick& tick);

}  // namespace ziggurat::devices
