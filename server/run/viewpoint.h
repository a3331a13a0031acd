// SPDX-License-Identifier: MIT
#pragma once
// The viewpoint of a picture.

#include <optional>
#include <string>
#include <vector>

#include "math/pose.h"
#include "render/view.h"
#include "scene/scene.h"
#include "world/state.h"

namespace ziggurat::run {

struct ViewOptions {
  std::optional<math::Vector3> eye;      ///< in W [m]; none: the whole arena is in view
  std::optional<math::Vector3> look_at;  ///< in W [m]; none: the middle of the arena
  std::string follow;                    ///< id of an entity; empty: the view stays
  unsigned width = 1280, height = 720;   ///< [px]
  double opening = 0.803;                ///< full angle from left to right [rad]
  render::Layers layers;
};

/// A box along the world's axes.
struct Extent {
  math::Vector3 low = math::Vector3::Zero(), high = math::Vector3::Zero();  ///< [m]
};

/// The arena. If the scene has a floor: from the floor up to the highest point of any link.
/// @param entities  all of them, in scene order
Extent extent_of(const scene::Scene& scene, const std::vector<scene::Entity>& entities,
                 const world::State& state);

/// An entity with what is near it.
/// @param first_link  into State::links
Extent extent_about(const scene::Entity& entity, std::size_t first_link, const world::State& state);

render::View choose_view(const ViewOptions& options, const Extent& extent);

}  // namespace ziggurat::run
