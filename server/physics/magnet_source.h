#pragma once
// A scene's magnet in the terms of magnetism/.

#include "magnetism/shape.h"
#include "scene/scene.h"

namespace ziggurat::physics {

/// A point where the scene gives no shape.
magnetism::Shape shape_of(const scene::Magnet& magnet);

/// Without current, in the anchor frame [A m^2].
math::Vector3 passive_moment(const scene::Magnet& magnet, const scene::Magnetism& magnetism);

/// Per unit of current, in the anchor frame [A m^2].
math::Vector3 active_moment(const scene::Magnet& magnet, const scene::Magnetism& magnetism);

}  // namespace ziggurat::physics
