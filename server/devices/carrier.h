// SPDX-License-Identifier: MIT
#pragma once
// An entity that carries devices, while they get their places in the layout.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

#include "scene/scene.h"
#include "world/layout.h"

namespace ziggurat::devices {

struct Carrier {
  const scene::Entity& entity;
  std::size_t index;                        ///< into Layout::entities, where it stands already
  const scene::ControllerDevices& enabled;  ///< by its controller; nothing without one
  double substep;                           ///< [s]
  mutable std::unordered_map<std::string_view, int> links =
      {};  ///< of the entity, by id, once one was looked for

  /// @param id  of a link, or "origin"; the reader has checked that it exists
  scene::Anchor anchor(const std::string& id) const {
    if (links.empty()) {
      for (std::size_t i = 0; i < entity.links.size(); ++i)
        links.emplace(entity.links[i].id, static_cast<int>(i));
    }
    const auto found = links.find(id);
    return found == links.end() ? scene::Anchor{} : scene::Anchor{found->second};
  }

  world::Mount mount(const scene::Anchor& anchor, const math::Pose& pose,
                     const world::Layout& layout) const {
    world::Mount result{index, std::nullopt, pose};
    if (anchor.link != scene::Anchor::origin) {
      result.link = layout.entities[index].links.begin + static_cast<std::size_t>(anchor.link);
    }
    return result;
  }
  world::Mount mount(const scene::Anchor& anchor, const math::Vector3& position,
                     const world::Layout& layout) const {
    return mount(anchor, math::Pose{position, math::Quaternion::Identity()}, layout);
  }
};

/// Appends what `make` makes of each of `from` to a list.
/// @return  where they stand
template <class From, class List, class Make>
world::Range append(const From& from, List& list, Make make) {
  const world::Range range{list.size(), from.size()};
  for (const auto& device : from) list.push_back(make(device));
  return range;
}

/// The same for a device that a robot has once: it is appended if `enabled`.
template <class List, class Layout>
world::Range append_if(bool enabled, List& list, const Layout& layout) {
  const world::Range range{list.size(), enabled ? 1u : 0u};
  if (enabled) list.push_back(layout);
  return range;
}

}  // namespace ziggurat::devices
