// SPDX-License-Identifier: MIT
#pragma once
// About how much memory the parts of a scene take: in the scene itself, in the world that is built
// from it and in what is told of it. Counted while a scene is read, so that one that would take too
// much is refused before.

#include <cstddef>
#include <cstdint>
#include <string>

#include "scene/parameters.h"
#include "scene/scene.h"

namespace ziggurat::scene {

struct Draft;
class Element;

/// A scene may take so many bytes of memory for each byte that it may have as it is written.
constexpr std::size_t memory_per_byte = 64;

std::size_t memory_of(const Params& params);
/// Memory of a device that a controller fixes to an anchor, in each robot.
std::size_t memory_of_mounted(const std::string& id);
/// Memory of a robot for the devices that its controller enables.
std::size_t memory_of(const ControllerDevices& devices);
/// @param controller  its own, or null
std::size_t memory_of(const Entity& entity, const Controller* controller);

/// Takes from the budget of the scene what an element takes beyond its own text. If that is too
/// much, a fault, and TooManyFaults.
/// @param memory   of what the element describes [bytes]
/// @param written  what was taken from the budget for it before [bytes]
void take_memory(Draft& draft, const Element& element, std::size_t memory, std::size_t written);
/// The same for copies that are not written out.
/// @param element  has an attribute `quantity`
/// @param each     of them takes [bytes]
void take_copies(Draft& draft, const Element& element, std::size_t each, std::uint64_t copies);

}  // namespace ziggurat::scene
