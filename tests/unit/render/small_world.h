// SPDX-License-Identifier: MIT
#pragma once
// Worlds of a few links, tags and LEDs, put together by hand.

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "render/renderer.h"

namespace ziggurat::render::testing {

using math::Pose;
using math::Vector3;

struct SmallWorld {
  scene::Scene scene;
  std::vector<scene::Entity> entities;
  world::Layout layout;
  world::State state;

  /// Adds an entity of one link; the link's frame is at its bottom centre. @returns the link's
  /// index
  std::size_t add(const scene::Geometry& geometry, const Pose& pose) {
    scene::Entity entity;
    scene::Link link;
    link.geometry = geometry;
    entity.links.push_back(link);
    entity.pose = pose;
    entities.push_back(entity);
    layout.entities.push_back({"e" + std::to_string(entities.size()), {}});
    layout.links.push_back({});
    state.origins.push_back(pose);
    state.links.push_back({pose});
    return entities.size() - 1;
  }

  /// Fixed in the link's frame.
  void add_tag(std::size_t link, const Pose& pose, double side_length, const std::string& payload) {
    world::TagLayout tag;
    tag.mount = {link, link, pose};
    tag.side_length = side_length;
    layout.tags.push_back(tag);
    state.tag_payloads.push_back(payload);
  }
  void add_led(std::size_t link, const Vector3& position, world::Color color) {
    world::LedLayout led;
    led.mount = {link, link, {position, math::Quaternion::Identity()}};
    layout.leds.push_back(led);
    state.led_colors.push_back(color);
  }
  void add_directional_led(std::size_t link, const Pose& pose, world::Color color) {
    world::DirectionalLedLayout led;
    led.mount = {link, link, pose};
    layout.directional_leds.push_back(led);
    state.directional_led_colors.push_back(color);
  }

  Picture picture(const View& view) const {
    Renderer renderer(scene, entities, layout);
    Picture result;
    renderer.draw(state, view, result);
    return result;
  }
};

/// A camera at the origin that looks along world's x axis, with world's z up in the picture.
inline View forward_view(unsigned width = 320, unsigned height = 240, double focal_length = 300) {
  return {look_at({0, 0, 0}, {1, 0, 0}),
          {focal_length, focal_length},
          {0.5 * width, 0.5 * height},
          width,
          height};
}

/// Position in the picture [px] of a point of the world [m].
inline math::Vector2 project(const View& view, const Vector3& point) {
  const Vector3 seen = math::inverse(view.camera) * point;
  return view.focal_length.cwiseProduct(seen.head<2>() / seen.z()) + view.principal_point;
}

struct Pixel {
  int red, green, blue;
};

/// The pixel that contains a point of the picture.
inline Pixel pixel(const Picture& picture, double u, double v) {
  const auto column = static_cast<std::size_t>(std::floor(u));
  const auto row = static_cast<std::size_t>(std::floor(v));
  const std::uint8_t* rgb = &picture.rgb.at(3 * (row * picture.width + column));
  return {rgb[0], rgb[1], rgb[2]};
}

inline Pixel pixel(const Picture& picture, const math::Vector2& point) {
  return pixel(picture, point.x(), point.y());
}

/// Sum of the differences of the three channels.
inline int difference(const Pixel& a, const Pixel& b) {
  return std::abs(a.red - b.red) + std::abs(a.green - b.green) + std::abs(a.blue - b.blue);
}

}  // namespace ziggurat::render::testing
