// SPDX-License-Identifier: MIT
#pragma once
// Surfaces of a drawing, and the polygons in the picture that show them.

#include <vector>

#include "render/drawing.h"
#include "render/meshes.h"
#include "render/shading.h"

namespace ziggurat::render {

/// A picture's lens, in rendered pixels.
struct Lens {
  double focal_x = 0, focal_y = 0, center_x = 0, center_y = 0;  ///< [px]
  double line_width = 0;                                        ///< [px]
  unsigned width = 0, height = 0;                               ///< [px]
};

/// The depth of the points `normal` . point = `offset` of the camera's frame.
DepthPlane depth_of_plane(const Lens& lens, const math::Vector3& normal, double offset);

/// Parts of a picture but for its background and its discs; its memory is used again.
struct Scenery {
  std::vector<Polygon> polygons;
  std::vector<Surface> surfaces;
  std::vector<math::Vector3> corners;  ///< working memory: of one body, in the camera's frame
  std::vector<ShadowMap::Corner> lit;  ///< the same seen from the sun
};

/// Bodies in view, tags and lines. Draws what throws shadows into the map.
void add_surfaces(const Drawing& drawing, const Meshes& meshes, const Lens& lens,
                  ShadowMap& shadows, Scenery& scenery);

/// A disc in the picture.
struct Disc {
  Polygon square;  ///< around it
  Surface surface;
};

/// Makes a disc of a mark. @returns false if it shows its back or is out of the picture
bool make_disc(const MarkInstance& mark, const Lens& lens, Disc& disc);

}  // namespace ziggurat::render
