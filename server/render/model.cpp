// SPDX-License-Identifier: MIT
#include "render/model.h"

#include <algorithm>
#include <cmath>

namespace ziggurat::render {
namespace {

/// A colour in sRGB, 0xRRGGBB.
Rgb rgb(unsigned hex) {
  const auto channel = [hex](unsigned shift) {
    return std::pow(static_cast<float>((hex >> shift) & 0xffu) / 255.0f, 2.2f);
  };
  return {channel(16), channel(8), channel(0)};
}

// The dialect has no colours. These tell apart what matters in a picture: fixed things, movable
// things, robots, and a robot's wheels and arms from its body.
Rgb color_of(const scene::Entity& entity, std::size_t link) {
  const scene::Geometry& geometry = entity.links[link].geometry;
  if (!entity.movable && !entity.controller) return rgb(0xb4b7ba);
  if (entity.kind == scene::EntityKind::box) return rgb(0xd3a469);
  if (entity.kind == scene::EntityKind::cylinder) return rgb(0x5e9aa0);
  if (std::holds_alternative<scene::Sphere>(geometry)) return rgb(0xc9ccd1);
  const bool wheel = std::holds_alternative<scene::Cylinder>(geometry);
  if (wheel && link != entity.reference_link) return rgb(0x4a4d52);
  const unsigned body = entity.controller ? 0x3f74b3 : 0xc7805a;
  const unsigned part = entity.controller ? 0x86a9d4 : 0xddb08f;
  return rgb(link == entity.reference_link ? body : part);
}

/// The largest of 1, 2, 5 times a power of ten of which at least ten go into `length`.
double round_tile(double length) {
  const double most = length / 10;
  const double power = std::pow(10.0, std::floor(std::log10(most)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= most * (1 + 1e-9)) return factor * power;
  }
  return power;
}

}  // namespace

void add_bodies(const scene::Entity& entity, Model& model) {
  for (std::size_t i = 0; i < entity.links.size(); ++i) {
    model.bodies.push_back({entity.links[i].geometry, color_of(entity, i)});
  }
}

Model make_model(const scene::Scene& scene, const std::vector<scene::Entity>& entities) {
  Model model;
  for (const scene::Entity& entity : entities) add_bodies(entity, model);
  model.has_floor = scene.physics.floor.has_value() ||
                    std::ranges::any_of(scene.physics.planes, [](const scene::Plane& plane) {
                      return plane.elevation == 0;
                    });
  model.arena_center = scene.arena.center.head<2>();
  model.arena_half_size = 0.5 * scene.arena.size.head<2>();
  model.floor_image = scene.floor_image;
  const double side = std::clamp(scene.arena.size.head<2>().minCoeff(), 0.01, 1e4);
  model.tile = round_tile(side);
  return model;
}

}  // namespace ziggurat::render
