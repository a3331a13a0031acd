// SPDX-License-Identifier: MIT
#pragma once
// Pictures of a state, on the CPU, without a display.

#include <memory>
#include <vector>

#include "render/view.h"
#include "scene/scene.h"
#include "world/layout.h"
#include "world/state.h"

namespace ziggurat::render {

/// Draws links, the floor, tags and LEDs as an eye would see them. The same state and view give the
/// same bytes.
class Renderer {
 public:
  /// @param entities  all of them, placed, in scene order
  /// @param layout    must outlive this
  Renderer(const scene::Scene& scene, const std::vector<scene::Entity>& entities,
           const world::Layout& layout);
  ~Renderer();
  Renderer(Renderer&&) noexcept;

  /// A new entity; its links are the next of the layout.
  /// @param first_link  its place in the layout; what was added from there on is forgotten
  void add(const scene::Entity& entity, std::size_t first_link);

  /// Everything in view at any distance, whatever a camera's range is.
  void draw(const world::State& state, const View& view, Picture& picture);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace ziggurat::render
