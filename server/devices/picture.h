#pragma once
// View of the renderer for the picture of a camera.

#include "render/renderer.h"
#include "world/layout.h"

namespace ziggurat::devices {

/// View of a camera. @param pose  X_WC
render::View view_of(const world::CameraLayout& camera, const math::Pose& pose);

}  // namespace ziggurat::devices
