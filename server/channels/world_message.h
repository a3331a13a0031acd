// SPDX-License-Identifier: MIT
#pragma once
// The message World: what does not change from tick to tick.

#include "channels/moment.h"
#include "channels/packing.h"
#include "ziggurat/v1/channels.pb.h"

namespace ziggurat::channels {

/// The link that a device moves with: its own, or the reference link for the entity's origin.
Mounted mounted(const Population& population, const world::Mount& mount);

/// The link that an entity's origin moves with: into State::links.
std::size_t reference_link(const Population& population, std::size_t entity);

v1::World describe(const Population& population, std::uint64_t generation);

/// Its part on devices. @param to  has everything else
void describe_devices(const Population& population, v1::World& to);

}  // namespace ziggurat::channels
