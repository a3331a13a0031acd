// SPDX-License-Identifier: MIT
#pragma once
// Draws arrays with OpenGL, and gives the pixels back.

#include <cstdint>
#include <vector>

#include "render/drawing.h"
#include "render/opengl.h"

namespace ziggurat::render {

class Canvas {
 public:
  /// @throws RenderError
  explicit Canvas(const Meshes& meshes);

  /// Takes meshes again, which have grown.
  void take(const Meshes& meshes);

  /// @throws RenderError if OpenGL fails
  void draw(const Drawing& drawing, const Model& model, const View& view, Picture& picture);

 private:
  struct Tile {
    unsigned x, y, width, height;  ///< [px] of the picture
  };

  void make_programs();
  void make_body_arrays();
  void make_mark_arrays();
  void make_line_arrays();
  void make_shadow_map();
  void take_floor(const Drawing& drawing, const Model& model);
  void make_target(unsigned width, unsigned height);
  void set_frame(const Drawing& drawing, const Model& model, const View& view, const Tile& tile);
  void draw_shadows(const Drawing& drawing);
  void draw_tile(const Drawing& drawing, const Tile& tile, unsigned oversampling, bool with_floor,
                 Picture& picture);
  enum class Bodies { all, visible };
  void draw_bodies(const Drawing& drawing, Bodies which);
  void draw_background(bool with_floor);
  void draw_marks_and_lines(const Drawing& drawing);
  void check() const;

  Context context_;
  GLuint body_program_ = 0, shadow_program_ = 0, floor_program_ = 0, sky_program_ = 0;
  GLuint mark_program_ = 0, line_program_ = 0;
  GLuint body_arrays_ = 0, mark_arrays_ = 0, line_arrays_ = 0, no_arrays_ = 0;
  GLuint mesh_buffers_[2]{};  // vertices and indices
  GLuint body_instances_ = 0, mark_instances_ = 0, line_instances_ = 0, frame_ = 0;
  GLuint shadow_map_ = 0, shadow_target_ = 0;
  GLuint floor_colors_ = 0;                        // texture; 0: it was not needed yet
  std::vector<world::FloorPaint> floor_;           // that it shows
  GLuint sampled_ = 0, resolved_ = 0;              // framebuffers: four samples per pixel, and one
  GLuint buffers_[3]{};                            // theirs
  unsigned target_width_ = 0, target_height_ = 0;  // of these [rendered px]
  std::vector<std::uint8_t> pixels_;               // read back: RGBA, top row first
};

}  // namespace ziggurat::render
