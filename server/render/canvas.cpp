// SPDX-License-Identifier: MIT
#include "render/canvas.h"

#include <algorithm>
#include <cmath>

namespace ziggurat::render {
namespace {

constexpr double line_width = 1.5;    // [px] of the picture
constexpr unsigned rows_of_band = 8;  // of the picture
constexpr unsigned lane_count = 8;
constexpr unsigned room = lane_count;  // behind a row, for a vector that begins in it

const Kernel& widest_kernel() {
  const Kernel* avx2 = avx2_kernel();
  return avx2 ? *avx2 : baseline_kernel();
}

/// The colour of a disc in a pixel, sRGB, and how much of the pixel it covers.
struct Blot {
  Float3 color{};
  float cover = 0;
};

/// The mean over the pixel's footprint.
/// @param x, y  its centre on the disc, whose radius is 1;  @param change  of x across and down,
/// and of y
Blot blot_at(const Surface& disc, float x, float y, const std::array<float, 4>& change) {
  unsigned inner = 0, outer = 0;
  for (unsigned i = 0; i < 4; ++i) {
    for (unsigned j = 0; j < 4; ++j) {
      const float across = 0.25f * static_cast<float>(i) - 0.375f;
      const float down = 0.25f * static_cast<float>(j) - 0.375f;
      const float u = x + across * change[0] + down * change[1];
      const float v = y + across * change[2] + down * change[3];
      const float square = u * u + v * v;
      if (square <= 0.72f) {
        ++inner;
      } else if (square <= 1) {
        ++outer;
      }
    }
  }
  if (inner + outer == 0) return {};
  // Its rim is darker.
  const auto count = static_cast<float>(inner + outer);
  const float shade = (static_cast<float>(inner) + 0.55f * static_cast<float>(outer)) / count;
  return {{disc.color[0] * shade, disc.color[1] * shade, disc.color[2] * shade}, count / 16};
}

/// The runs that the pixels of a row are in, from left to right.
class OpenRuns {
 public:
  static constexpr std::uint32_t none = ~0u;

  explicit OpenRuns(std::vector<Run>& runs) : runs_(runs) {}

  /// The surface of all samples of the last pixel, if there is only one.
  std::uint32_t whole() const { return whole_; }

  /// @param here  surfaces of the samples of pixel x
  void go_on(unsigned x, const std::array<std::uint32_t, 4>& here) {
    const bool is_whole = here[0] == here[1] && here[0] == here[2] && here[0] == here[3];
    if (is_whole && here[0] == whole_) return;
    whole_ = is_whole ? here[0] : none;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      Run& run = runs_[open_[i]];
      if (std::ranges::find(here, run.number) != here.end()) {
        open_[kept++] = open_[i];
      } else {
        run.end = x;
      }
    }
    count_ = kept;
    for (const std::uint32_t number : here) {
      const auto is_open = [&](std::size_t run) { return runs_[run].number == number; };
      if (std::any_of(open_.begin(), open_.begin() + static_cast<std::ptrdiff_t>(count_), is_open))
        continue;
      open_[count_++] = runs_.size();
      runs_.push_back({number, x, x});
    }
  }

  void end(unsigned x) {
    for (std::size_t i = 0; i < count_; ++i) runs_[open_[i]].end = x;
  }

 private:
  std::vector<Run>& runs_;
  std::array<std::size_t, 4> open_{};  // into runs_
  std::size_t count_ = 0;
  std::uint32_t whole_ = none;
};

/// A row of colours as bytes.
void pack(const RowColors& colors, unsigned width, std::uint8_t* rgb) {
  for (unsigned x = 0; x < width; ++x, rgb += 3) {
    rgb[0] = static_cast<std::uint8_t>(colors.red[x] + 0.5f);
    rgb[1] = static_cast<std::uint8_t>(colors.green[x] + 0.5f);
    rgb[2] = static_cast<std::uint8_t>(colors.blue[x] + 0.5f);
  }
}

}  // namespace

Canvas::Canvas(const Kernel* kernel) : kernel_(kernel ? *kernel : widest_kernel()) {}

void Canvas::set_frame(const Drawing& drawing, const Model& model, const View& view) {
  const double n = view.oversampling;
  lens_ = {n * view.focal_length.x(),
           n * view.focal_length.y(),
           n * view.principal_point.x(),
           n * view.principal_point.y(),
           n * line_width,
           view.width * view.oversampling,
           view.height * view.oversampling};
  frame_.center_x = lens_.center_x;
  frame_.center_y = lens_.center_y;
  frame_.focal_x = lens_.focal_x;
  frame_.focal_y = lens_.focal_y;
  frame_.sun = drawing.sun;
  frame_.right = drawing.right;
  frame_.ahead = drawing.ahead;
  frame_.up = drawing.up;
  // Floats tell two sides of a tile only near their own zero.
  const math::Vector3& eye = view.camera.position;
  const math::Vector3 origin(std::floor(eye.x() / (2 * model.tile)) * 2 * model.tile,
                             std::floor(eye.y() / (2 * model.tile)) * 2 * model.tile, 0);
  frame_.eye = to_floats(math::Vector3(eye - origin));
  frame_.tile = static_cast<float>(model.tile);
  const math::Vector2 center = model.arena_center - origin.head<2>();
  frame_.arena_center = {static_cast<float>(center.x()), static_cast<float>(center.y())};
  frame_.arena_half = {static_cast<float>(model.arena_half_size.x()),
                       static_cast<float>(model.arena_half_size.y())};
  frame_.has_floor = model.has_floor && eye.z() != 0;
  if (frame_.has_floor) {
    const math::Vector3 up(drawing.up[0], drawing.up[1], drawing.up[2]);
    frame_.floor_depth = depth_of_plane(lens_, up, -eye.z());
  }
  frame_.painting = painting_ ? &*painting_ : nullptr;
  frame_.light_from_camera = drawing.light_from_camera;
  frame_.shadow_texel = static_cast<float>(drawing.shadow_texel);
  frame_.shadows = &shadows_;
}

/// The colours of the floor, when they change.
void Canvas::take_floor(const Drawing& drawing, const Model& model) {
  if (!model.floor_image && drawing.floor.empty()) {
    painting_.reset();
  } else if (!painting_ || drawing.floor != painted_) {
    painting_ = floor_picture(model, drawing.floor);
    painted_ = drawing.floor;
  }
}

/// Runs of pixels that show one surface, at least in a sample.
void Canvas::find_runs(unsigned row) {
  runs_.clear();
  std::array<const std::uint32_t*, 4> line{};
  for (unsigned i = 0; i < 4; ++i) line[i] = &samples_.numbers[samples_.line(row, i)];
  OpenRuns open(runs_);
  for (unsigned x = 0; x < samples_.width;) {
    const std::uint32_t whole = open.whole();
    if (whole != OpenRuns::none && x + lane_count <= samples_.width) {
      std::uint32_t differs = 0;
      for (unsigned j = x; j < x + lane_count; ++j) {
        differs |= (line[0][j] ^ whole) | (line[1][j] ^ whole) | (line[2][j] ^ whole) |
                   (line[3][j] ^ whole);
      }
      if (differs == 0) {
        x += lane_count;
        continue;
      }
    }
    for (const unsigned end = std::min(x + lane_count, samples_.width); x < end; ++x) {
      open.go_on(x, {line[0][x], line[1][x], line[2][x], line[3][x]});
    }
  }
  open.end(samples_.width);
}

/// Covers the samples of a row in which a disc is nearest.
void Canvas::draw_disc(const Disc& disc, unsigned row) {
  if (row + 1 <= disc.square.top || row >= disc.square.bottom) return;
  std::array<Stretch, 4> lines{};
  unsigned begin = lens_.width, end = 0;
  for (unsigned i = 0; i < 4; ++i) {
    lines[i] = covered(disc.square, row + sample_y[i], sample_x[i], lens_.width);
    if (lines[i].begin == lines[i].end) continue;
    begin = std::min(begin, lines[i].begin);
    end = std::max(end, lines[i].end);
  }
  const std::size_t stride = samples_.stride;
  float* depths = &samples_.depths[samples_.line(row, 0)];
  const auto& rows = disc.surface.coordinates;
  const auto fx = static_cast<float>(1 / lens_.focal_x), fy = static_cast<float>(1 / lens_.focal_y);
  for (unsigned x = begin; x < end; ++x) {
    const DepthPlane& plane = disc.surface.depth;
    const auto z = static_cast<float>(1 / std::max(plane.at(x + 0.5, row + 0.5), 1e-9));
    const Float3 at{static_cast<float>((x + 0.5 - lens_.center_x) / lens_.focal_x) * z,
                    static_cast<float>((row + 0.5 - lens_.center_y) / lens_.focal_y) * z, z};
    std::array<float, 2> place{};
    std::array<float, 4> change{};
    for (std::size_t i = 0; i < 2; ++i) {
      const float product = rows[i][0] * at[0] + rows[i][1] * at[1] + rows[i][2] * at[2];
      place[i] = product + rows[i][3];
      change[2 * i] = z * (rows[i][0] * fx - static_cast<float>(plane.a) * product);
      change[2 * i + 1] = z * (rows[i][1] * fy - static_cast<float>(plane.b) * product);
    }
    const Blot blot = blot_at(disc.surface, place[0], place[1], change);
    if (blot.cover == 0) continue;
    float samples = 0;
    for (unsigned i = 0; i < 4; ++i) {
      if (x < lines[i].begin || x >= lines[i].end) continue;
      const auto depth =
          static_cast<float>(disc.square.depth.at(x + sample_x[i], row + sample_y[i]));
      if (!(depth > depths[i * stride + x])) continue;
      depths[i * stride + x] = depth;
      samples += 1;
    }
    const float part = blot.cover * samples / 4;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      float& color = colors_[channel * stride + x];
      color += (255 * blot.color[channel] - color) * part;
    }
  }
}

void Canvas::draw_row(unsigned row) {
  std::fill(colors_.begin(), colors_.end(), 0.0f);
  find_runs(row);
  for (const Run& run : runs_) {
    const Surface* surface = run.number < first_surface_number
                                 ? nullptr
                                 : &scenery_.surfaces[run.number - first_surface_number];
    kernel_.shade(frame_, surface, row, run, samples_, colors());
  }
  for (const Disc& disc : discs_) draw_disc(disc, row);
}

void Canvas::draw_band(unsigned first_row, unsigned rows) {
  samples_.first_row = first_row;
  samples_.rows = rows;
  const std::size_t size = std::size_t{rows} * 4 * samples_.stride;
  samples_.depths.assign(size, 0);
  samples_.numbers.assign(size, sky_number);
  for (const Polygon& polygon : scenery_.polygons) {
    if (polygon.top < first_row + rows && polygon.bottom > first_row)
      kernel_.draw(polygon, samples_);
  }
  if (!frame_.has_floor) return;
  for (unsigned row = first_row; row < first_row + rows; ++row) {
    kernel_.lay_floor(frame_, row, samples_);
  }
}

/// A row of the picture, as the mean of n x n rendered pixels each.
void Canvas::draw_mean_row(unsigned v, unsigned n, std::uint8_t* rgb) {
  std::ranges::fill(sums_, 0.0f);
  const std::size_t width = sums_.size() / 3;
  const float share = 1 / static_cast<float>(n * n);
  for (unsigned row = v * n; row < (v + 1) * n; ++row) {
    draw_row(row);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const float* from = &colors_[channel * samples_.stride];
      float* to = &sums_[channel * width];
      for (std::size_t x = 0; x < width; ++x) {
        for (unsigned i = 0; i < n; ++i) to[x] += share * *from++;
      }
    }
  }
  pack({&sums_[0], &sums_[width], &sums_[2 * width]}, static_cast<unsigned>(width), rgb);
}

RowColors Canvas::colors() {
  return {&colors_[0], &colors_[samples_.stride], &colors_[2 * samples_.stride]};
}

void Canvas::draw(const Drawing& drawing, const Meshes& meshes, const Model& model,
                  const View& view, Picture& picture) {
  picture.width = view.width;
  picture.height = view.height;
  picture.rgb.resize(std::size_t{3} * view.width * view.height);
  take_floor(drawing, model);
  set_frame(drawing, model, view);
  add_surfaces(drawing, meshes, lens_, shadows_, scenery_);
  discs_.clear();
  for (const MarkInstance& mark : drawing.marks) {
    Disc disc;
    if (mark.code[0] == MarkInstance::disc && make_disc(mark, lens_, disc)) discs_.push_back(disc);
  }
  const unsigned n = view.oversampling;
  samples_.width = lens_.width;
  samples_.stride = lens_.width + room;
  colors_.resize(3 * samples_.stride);
  sums_.resize(std::size_t{3} * view.width);
  for (unsigned v = 0; v < view.height; ++v) {
    if (v % rows_of_band == 0) draw_band(v * n, std::min(rows_of_band, view.height - v) * n);
    std::uint8_t* rgb = &picture.rgb[std::size_t{3} * v * view.width];
    if (n == 1) {
      draw_row(v);
      pack(colors(), view.width, rgb);
    } else {
      draw_mean_row(v, n, rgb);
    }
  }
}

}  // namespace ziggurat::render
