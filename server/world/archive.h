// SPDX-License-Identifier: MIT
#pragma once
// State of a tick in an archive. Indices into lists are checked against the layout.

#include "math/archive.h"
#include "world/commands.h"
#include "world/layout.h"
#include "world/state.h"

namespace ziggurat::world {

void archive(math::Archive& archive, const Layout& layout, State& state);
/// @param state  the one that was archived before
void archive(math::Archive& archive, const Layout& layout, const State& state,
             Observations& observations);
void archive(math::Archive& archive, const Layout& layout, Commands& commands);

}  // namespace ziggurat::world
