#pragma once
// Whether the state is one that a world can have.

#include <cstddef>
#include <optional>

#include "world/layout.h"
#include "world/state.h"

namespace ziggurat::simulation {

/// The first entity with a pose or a velocity that is not finite, into Layout::entities.
std::optional<std::size_t> first_not_finite(const world::Layout& layout, const world::State& state);

}  // namespace ziggurat::simulation
