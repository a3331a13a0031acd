#pragma once
// Pictures of the cameras that ask for them, taken at the end of a tick's physics.

#include <cstddef>
#include <optional>
#include <vector>

#include "devices/tick.h"
#include "render/renderer.h"

namespace ziggurat::devices {

class Pictures {
 public:
  /// Without a camera that asks, nothing is made, and nothing of OpenGL is loaded.
  explicit Pictures(const Setting& setting) { add(setting); }

  void add(const Setting& setting);

  /// Empty pictures, as of tick 0, of cameras that are new. @throws render::RenderError if there
  /// can't be any
  void start(Tick& tick);

  /// Replaces all of them. @throws render::RenderError
  void sense(Tick& tick);

 private:
  std::vector<std::size_t> cameras_;  // into Layout::cameras, ascending
  std::optional<render::Renderer> renderer_;
  render::Picture picture_;
};

/// What a camera sees. @param pose  X_WC
render::View view_of(const world::CameraLayout& camera, const math::Pose& pose);

}  // namespace ziggurat::devices
