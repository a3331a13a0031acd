// SPDX-License-Identifier: MIT
#pragma once
// Draws arrays into a picture, band by band, so that what is worked on stays in the cache.

#include <optional>
#include <vector>

#include "render/drawing.h"
#include "render/floor_picture.h"
#include "render/shading.h"
#include "render/surfaces.h"

namespace ziggurat::render {

/// Keeps what it needs from picture to picture; another canvas draws the same bits.
class Canvas {
 public:
  /// @param kernel  default: the widest one that this processor has
  explicit Canvas(const Kernel* kernel = nullptr);

  void draw(const Drawing& drawing, const Meshes& meshes, const Model& model, const View& view,
            Picture& picture);

 private:
  void set_frame(const Drawing& drawing, const Model& model, const View& view);
  void take_floor(const Drawing& drawing, const Model& model);
  void find_runs(unsigned row);
  void draw_disc(const Disc& disc, unsigned row);
  void draw_row(unsigned row);
  void draw_mean_row(unsigned v, unsigned n, std::uint8_t* rgb);
  RowColors colors();
  void draw_band(unsigned first_row, unsigned rows);

  const Kernel& kernel_;
  Lens lens_;
  Frame frame_;
  ShadowMap shadows_;
  Scenery scenery_;
  std::vector<Disc> discs_;
  std::optional<FloorPicture> painting_;
  std::vector<world::FloorPaint> painted_;  // that it shows
  Samples samples_;
  std::vector<Run> runs_;      // of a row
  std::vector<float> colors_;  // of a row: red, green, blue
  std::vector<float> sums_;    // of a row of the picture: of its rendered pixels
};

}  // namespace ziggurat::render
