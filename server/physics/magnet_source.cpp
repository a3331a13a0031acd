// SPDX-License-Identifier: MIT
#include "physics/magnet_source.h"

#include "magnetism/dipole.h"

namespace ziggurat::physics {

magnetism::Shape shape_of(const scene::Magnet& magnet) {
  if (!magnet.shape) return magnetism::PointShape{};
  switch (magnet.shape->kind) {
    case scene::MagnetShape::Kind::box:
      return magnetism::Box{magnet.shape->size};
    case scene::MagnetShape::Kind::cylinder:
      return magnetism::Cylinder{magnet.shape->radius, magnet.shape->height};
    case scene::MagnetShape::Kind::sphere:
      break;
  }
  return magnetism::Sphere{magnet.shape->radius};
}

math::Vector3 passive_moment(const scene::Magnet& magnet, const scene::Magnetism& magnetism) {
  return magnetism::moment_of_dialect_field(magnet.passive_field, magnetism.force_constant) +
         magnet.moment +
         magnetism::moment_of_remanence(magnet.remanence, magnetism::volume(shape_of(magnet)));
}

math::Vector3 active_moment(const scene::Magnet& magnet, const scene::Magnetism& magnetism) {
  return magnetism::moment_of_dialect_field(magnet.active_field, magnetism.force_constant);
}

}  // namespace ziggurat::physics
