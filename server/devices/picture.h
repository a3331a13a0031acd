#pragma once
// How the renderer takes the picture of a camera.

#include "render/renderer.h"
#include "world/layout.h"

namespace ziggurat::devices {

/// What a camera sees. @param pose  X_WC
render::View view_of(const world::CameraLayout& camera, const math::Pose& pose);

}  // namespace ziggurat::devices
