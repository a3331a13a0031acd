// SPDX-License-Identifier: MIT
#include "render/canvas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "render/floor_picture.h"

namespace ziggurat::render {
namespace {

constexpr unsigned largest_tile = 1024;  // [px] of the picture, so that memory stays bounded
constexpr float near_plane = 1e-3f;      // [m]
constexpr float line_width = 1.5f;       // [px] of the picture

/// The uniforms of shaders::common.
struct Frame {
  Matrix4 clip_from_camera;
  Matrix4 light_from_camera;
  std::array<float, 4> sun, right, ahead, up, ground, arena, painting;
};

std::array<float, 4> with(const Float3& xyz, double w) {
  return {xyz[0], xyz[1], xyz[2], static_cast<float>(w)};
}

const void* offset(std::size_t bytes) { return reinterpret_cast<const void*>(bytes); }

template <class T>
GLsizeiptr bytes(std::span<const T> list) {
  return static_cast<GLsizeiptr>(list.size_bytes());
}

/// The mean of each n x n pixels of RGBA, as RGB.
/// @param stride  of `from`, in pixels
void shrink(const std::uint8_t* from, std::size_t stride, std::size_t width, unsigned n,
            std::uint8_t* to) {
  for (std::size_t x = 0; x < width; ++x) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      unsigned sum = n * n / 2;
      for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t i = 0; i < n; ++i) sum += from[(j * stride + x * n + i) * 4 + channel];
      }
      to[x * 3 + channel] = static_cast<std::uint8_t>(sum / (n * n));
    }
  }
}

/// The same for the usual n, which the compiler can unroll.
void shrink_row(const std::uint8_t* from, std::size_t stride, std::size_t width, unsigned n,
                std::uint8_t* to) {
  if (n == 1) return shrink(from, stride, width, 1, to);
  if (n != 2) return shrink(from, stride, width, n, to);
  const std::uint8_t* below = from + 4 * stride;
  for (std::size_t x = 0; x < width; ++x, from += 8, below += 8, to += 3) {
    for (std::size_t i = 0; i < 3; ++i) {
      to[i] = static_cast<std::uint8_t>((from[i] + from[4 + i] + below[i] + below[4 + i] + 2) >> 2);
    }
  }
}

}  // namespace

Canvas::Canvas(const Meshes& meshes) {
  const OpenGl& gl = context_.gl();
  make_programs();
  make_body_arrays();
  take(meshes);
  make_mark_arrays();
  make_line_arrays();
  make_shadow_map();
  gl.create_vertex_arrays(1, &no_arrays_);
  gl.create_buffers(1, &frame_);
  gl.bind_buffer_base(GL_UNIFORM_BUFFER, 0, frame_);
  gl.bind_texture_unit(0, shadow_map_);
  gl.clip_control(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  check();
}

void Canvas::make_shadow_map() {
  const OpenGl& gl = context_.gl();
  gl.create_textures(GL_TEXTURE_2D, 1, &shadow_map_);
  gl.texture_storage(shadow_map_, 1, GL_DEPTH_COMPONENT32F, shadow_size, shadow_size);
  gl.texture_parameter(shadow_map_, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.texture_parameter(shadow_map_, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.texture_parameter(shadow_map_, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  gl.texture_parameter(shadow_map_, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
  const float lit[]{1, 1, 1, 1};
  gl.texture_parameters(shadow_map_, GL_TEXTURE_BORDER_COLOR, lit);
  gl.texture_parameter(shadow_map_, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  gl.texture_parameter(shadow_map_, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  gl.create_framebuffers(1, &shadow_target_);
  gl.named_framebuffer_texture(shadow_target_, GL_DEPTH_ATTACHMENT, shadow_map_, 0);
  gl.named_framebuffer_draw_buffer(shadow_target_, GL_NONE);
}

/// Draws the colours of the floor into a texture when they change.
void Canvas::take_floor(const Drawing& drawing, const Model& model) {
  if (floor_colors_ != 0 ? drawing.floor == floor_ : !model.floor_image && drawing.floor.empty())
    return;
  const OpenGl& gl = context_.gl();
  const FloorPicture picture = floor_picture(model, drawing.floor);
  const auto width = static_cast<GLsizei>(picture.width),
             height = static_cast<GLsizei>(picture.height);
  if (floor_colors_ == 0) {
    gl.create_textures(GL_TEXTURE_2D, 1, &floor_colors_);
    gl.texture_storage(floor_colors_, 1, GL_RGBA8, width, height);
    gl.texture_parameter(floor_colors_, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl.texture_parameter(floor_colors_, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl.texture_parameter(floor_colors_, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.texture_parameter(floor_colors_, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    gl.bind_texture_unit(1, floor_colors_);
  }
  gl.texture_sub_image(floor_colors_, 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE,
                       picture.rgba.data());
  floor_ = drawing.floor;
}

void Canvas::make_target(unsigned width, unsigned height) {
  if (width <= target_width_ && height <= target_height_) return;
  const OpenGl& gl = context_.gl();
  target_width_ = std::max(width, target_width_);
  target_height_ = std::max(height, target_height_);
  const auto w = static_cast<GLsizei>(target_width_), h = static_cast<GLsizei>(target_height_);
  const GLuint targets[] = {sampled_, resolved_};
  gl.delete_framebuffers(2, targets);  // 0 is ignored
  gl.delete_renderbuffers(3, buffers_);
  gl.create_framebuffers(1, &sampled_);
  gl.create_framebuffers(1, &resolved_);
  gl.create_renderbuffers(3, buffers_);
  gl.named_renderbuffer_storage(buffers_[0], 4, GL_RGBA8, w, h);
  gl.named_renderbuffer_storage(buffers_[1], 4, GL_DEPTH_COMPONENT32F, w, h);
  gl.named_renderbuffer_storage(buffers_[2], 0, GL_RGBA8, w, h);
  gl.named_framebuffer_renderbuffer(sampled_, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffers_[0]);
  gl.named_framebuffer_renderbuffer(sampled_, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, buffers_[1]);
  gl.named_framebuffer_renderbuffer(resolved_, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffers_[2]);
  for (const GLuint target : {sampled_, resolved_}) {
    if (gl.check_named_framebuffer_status(target, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
      throw RenderError(fmt::format("OpenGL has no room for a picture of {} x {}", w, h));
    }
  }
  pixels_.resize(std::size_t{4} * target_width_ * target_height_);
}

void Canvas::check() const {
  const GLenum error = context_.gl().get_error();
  if (error != GL_NO_ERROR) throw RenderError(fmt::format("OpenGL reports error {:#x}", error));
}

void Canvas::set_frame(const Drawing& drawing, const Model& model, const View& view,
                       const Tile& tile) {
  Frame frame{};
  // u / width goes from 0 to 1 over the tile: -1 to 1 in clip coordinates. Rows are read back from
  // the lowest on, so v grows with y.
  const auto set = [&](std::size_t axis, double focal_length, double principal, double begin,
                       double size) {
    frame.clip_from_camera[5 * axis] = static_cast<float>(2 * focal_length / size);
    frame.clip_from_camera[8 + axis] = static_cast<float>(2 * (principal - begin) / size - 1);
  };
  set(0, view.focal_length.x(), view.principal_point.x(), tile.x, tile.width);
  set(1, view.focal_length.y(), view.principal_point.y(), tile.y, tile.height);
  frame.clip_from_camera[11] = 1;
  frame.clip_from_camera[14] = near_plane;

  // Floats tell two sides of a tile only near their own zero.
  const auto& eye = view.camera.position;
  const math::Vector2 origin(std::floor(eye.x() / (2 * model.tile)) * 2 * model.tile,
                             std::floor(eye.y() / (2 * model.tile)) * 2 * model.tile);
  frame.light_from_camera = drawing.light_from_camera;
  frame.sun = with(drawing.sun, drawing.shadow_texel);
  frame.right = with(drawing.right, eye.x() - origin.x());
  frame.ahead = with(drawing.ahead, eye.y() - origin.y());
  frame.up = with(drawing.up, eye.z());
  frame.ground = {static_cast<float>(model.tile), 2 * line_width / static_cast<float>(tile.width),
                  near_plane, 2 * line_width / static_cast<float>(tile.height)};
  const math::Vector2 center = model.arena_center - origin;
  frame.arena = {static_cast<float>(center.x()), static_cast<float>(center.y()),
                 static_cast<float>(model.arena_half_size.x()),
                 static_cast<float>(model.arena_half_size.y())};
  frame.painting[0] = model.floor_image || !drawing.floor.empty() ? 1 : 0;
  context_.gl().named_buffer_data(frame_, sizeof frame, &frame, GL_DYNAMIC_DRAW);
}

void Canvas::draw_bodies(const Drawing& drawing, Bodies which) {
  const OpenGl& gl = context_.gl();
  gl.bind_vertex_array(body_arrays_);
  for (const Batch& batch : drawing.batches) {
    const std::size_t count = which == Bodies::all ? batch.all : batch.visible;
    if (count == 0) continue;
    gl.draw_elements(GL_TRIANGLES, static_cast<GLsizei>(batch.mesh.indices), GL_UNSIGNED_INT,
                     offset(batch.mesh.first_index * sizeof(std::uint32_t)),
                     static_cast<GLsizei>(count), batch.mesh.base_vertex,
                     static_cast<GLuint>(batch.first));
  }
}

void Canvas::draw_shadows(const Drawing& drawing) {
  const OpenGl& gl = context_.gl();
  gl.bind_framebuffer(GL_FRAMEBUFFER, shadow_target_);
  gl.viewport(0, 0, shadow_size, shadow_size);
  const float farthest = 1;
  gl.clear_named_framebuffer(shadow_target_, GL_DEPTH, 0, &farthest);
  gl.enable(GL_DEPTH_TEST);
  gl.depth_func(GL_LESS);
  gl.disable(GL_CULL_FACE);
  gl.enable(GL_POLYGON_OFFSET_FILL);
  gl.polygon_offset(1.5f, 0);
  gl.use_program(shadow_program_);
  draw_bodies(drawing, Bodies::all);
  gl.disable(GL_POLYGON_OFFSET_FILL);
}

/// Floor and sky, where nothing is in front of them.
void Canvas::draw_background(bool with_floor) {
  const OpenGl& gl = context_.gl();
  gl.disable(GL_CULL_FACE);
  gl.bind_vertex_array(no_arrays_);
  if (with_floor) {
    gl.use_program(floor_program_);
    gl.draw_arrays(GL_TRIANGLES, 0, 3);
  }
  gl.depth_func(GL_GEQUAL);
  gl.use_program(sky_program_);
  gl.draw_arrays(GL_TRIANGLES, 0, 3);
  gl.depth_func(GL_GREATER);
}

void Canvas::draw_marks_and_lines(const Drawing& drawing) {
  const OpenGl& gl = context_.gl();
  gl.enable(GL_CULL_FACE);
  gl.use_program(mark_program_);
  gl.bind_vertex_array(mark_arrays_);
  gl.enable(GL_BLEND);
  gl.draw_arrays_instanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(drawing.marks.size()));
  gl.disable(GL_BLEND);
  if (drawing.lines.empty()) return;
  gl.disable(GL_CULL_FACE);
  gl.use_program(line_program_);
  gl.bind_vertex_array(line_arrays_);
  gl.draw_arrays_instanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(drawing.lines.size()));
}

/// @param with_floor  and not seen edge on
void Canvas::draw_tile(const Drawing& drawing, const Tile& tile, unsigned oversampling,
                       bool with_floor, Picture& picture) {
  const OpenGl& gl = context_.gl();
  const auto w = static_cast<GLsizei>(tile.width * oversampling);
  const auto h = static_cast<GLsizei>(tile.height * oversampling);
  gl.bind_framebuffer(GL_FRAMEBUFFER, sampled_);
  gl.viewport(0, 0, w, h);
  const float infinity = 0;
  gl.clear_named_framebuffer(sampled_, GL_DEPTH, 0, &infinity);
  gl.enable(GL_DEPTH_TEST);
  // The nearest first: what is behind them is not coloured at all.
  gl.depth_func(GL_GREATER);
  gl.enable(GL_CULL_FACE);
  gl.front_face(GL_CW);  // with v downwards, the picture is a mirror image to OpenGL
  gl.use_program(body_program_);
  draw_bodies(drawing, Bodies::visible);
  draw_background(with_floor);
  draw_marks_and_lines(drawing);

  gl.blit_named_framebuffer(sampled_, resolved_, 0, 0, w, h, 0, 0, w, h, GL_COLOR_BUFFER_BIT,
                            GL_NEAREST);
  gl.bind_framebuffer(GL_FRAMEBUFFER, resolved_);
  gl.read_pixels(0, 0, w, h, GL_RGBA, GL_UNSIGNED_BYTE, pixels_.data());
  const std::size_t stride = std::size_t{tile.width} * oversampling;
  for (std::size_t row = 0; row < tile.height; ++row) {
    shrink_row(pixels_.data() + 4 * row * oversampling * stride, stride, tile.width, oversampling,
               picture.rgb.data() + 3 * ((tile.y + row) * picture.width + tile.x));
  }
}

void Canvas::draw(const Drawing& drawing, const Model& model, const View& view, Picture& picture) {
  picture.width = view.width;
  picture.height = view.height;
  picture.rgb.resize(std::size_t{3} * view.width * view.height);
  context_.make_current();
  const OpenGl& gl = context_.gl();
  make_target(std::min(view.width, largest_tile) * view.oversampling,
              std::min(view.height, largest_tile) * view.oversampling);
  gl.named_buffer_data(body_instances_, bytes(std::span(drawing.bodies)), drawing.bodies.data(),
                       GL_DYNAMIC_DRAW);
  gl.named_buffer_data(mark_instances_, bytes(std::span(drawing.marks)), drawing.marks.data(),
                       GL_DYNAMIC_DRAW);
  gl.named_buffer_data(line_instances_, bytes(std::span(drawing.lines)), drawing.lines.data(),
                       GL_DYNAMIC_DRAW);
  take_floor(drawing, model);
  set_frame(drawing, model, view, {0, 0, view.width, view.height});
  if (drawing.shadow_texel > 0) draw_shadows(drawing);
  const bool with_floor = model.has_floor && view.camera.position.z() != 0;
  for (unsigned y = 0; y < view.height; y += largest_tile) {
    for (unsigned x = 0; x < view.width; x += largest_tile) {
      const Tile tile{x, y, std::min(largest_tile, view.width - x),
                      std::min(largest_tile, view.height - y)};
      set_frame(drawing, model, view, tile);
      draw_tile(drawing, tile, view.oversampling, with_floor, picture);
    }
  }
  check();
}

}  // namespace ziggurat::render
