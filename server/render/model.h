// SPDX-License-Identifier: MIT
#pragma once
// Model of a scene's constant looks: the surfaces of its links, and its floor.

#include <memory>
#include <vector>

#include "images/image.h"
#include "scene/scene.h"

namespace ziggurat::render {

/// Red, green, blue, 0 to 1, linear light.
using Rgb = Eigen::Vector3f;

/// The surface of a link.
struct Body {
  scene::Geometry geometry;  ///< in the link's frame
  Rgb color;
};

struct Model {
  std::vector<Body> bodies;                               ///< one per link, as State::links
  bool has_floor = false;                                 ///< at z = 0, also ground of planes
  double tile = 0;                                        ///< side of the squares on the floor [m]
  math::Vector2 arena_center = math::Vector2::Zero();     ///< [m]
  math::Vector2 arena_half_size = math::Vector2::Zero();  ///< [m]
  std::shared_ptr<const images::Image> floor_image;       ///< over the arena; null: none
};

void add_bodies(const scene::Entity& entity, Model& model);

/// @param entities  all of them, placed, in scene order
Model make_model(const scene::Scene& scene, const std::vector<scene::Entity>& entities);

}  // namespace ziggurat::render
