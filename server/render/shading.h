// SPDX-License-Identifier: MIT
#pragma once
// The loops over samples and pixels of a picture, eight at a time: which surface each sample shows,
// and the colours of runs of pixels.
//
// A picture is drawn in rendered pixels, several of which may become one ("px" here). Depth is
// 1 / z of the camera's frame [1/m]: linear over the picture on a plane, and 0 at infinity. In
// floating point it is equally fine, relatively, at all distances.
//
// Same bits everywhere, as in magnetism/kernel.h: no fused operation, and eight lanes are one unit
// whatever the register width.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/drawing.h"
#include "render/floor_picture.h"
#include "render/polygon.h"
#include "render/shadow_map.h"

namespace ziggurat::render {

/// Surface of a face, tag or line. Numbers 0 and 1 of samples are the sky and the floor; i + 2 is
/// surface i.
struct Surface {
  enum class Kind { flat, round, tag, plain };
  Kind kind = Kind::plain;
  bool has_rim = false;  ///< of a round face: coordinate 0 is the length of 0 and 1
  DepthPlane depth;      ///< not of round ones
  Float3 normal{};       ///< unit; of flat ones
  Float3 center{};       ///< of a ball; of a cylinder, the point of its axis nearest to the camera
  Float3 axis{};         ///< of a cylinder, unit; of a ball 0
  float radius = 0;      ///< of either [m]
  /// Coordinates of a point of the camera's frame, each xyz . point + w: on a face its edges are at
  /// -1 and 1, on a tag x and y are.
  std::array<std::array<float, 4>, 3> coordinates{};
  Float3 half_size{};  ///< how long one unit of each coordinate is [m]
  float smallest = 0;  ///< full extent of the body [m]
  Float3 color{};      ///< linear light; of plain ones sRGB
  /// White modules of a tag, a bit each: rows from up (+x) on, columns from left (+y) on, with the
  /// white around its 10 x 10 modules.
  std::array<std::uint16_t, 12> white_modules{};
};

/// Brightness of a tag's modules, sRGB.
constexpr float white_of_tags = 0.95f, black_of_tags = 0.06f;

constexpr std::uint32_t sky_number = 0, floor_number = 1, first_surface_number = 2;

/// Constants of a picture.
struct Frame {
  double center_x = 0, center_y = 0;     ///< principal point [px]
  double focal_x = 0, focal_y = 0;       ///< [px]
  Float3 sun{}, right{}, ahead{}, up{};  ///< unit; the last three are world's x, y and z
  Float3 eye{};                          ///< in the world, x and y less the origin of tiles [m]
  float tile = 0;                        ///< side of a tile of the floor [m]
  std::array<float, 2> arena_center{};   ///< less the origin of tiles [m]
  std::array<float, 2> arena_half{};     ///< [m]
  bool has_floor = false;                ///< and not seen edge on
  DepthPlane floor_depth;
  const FloorPicture* painting = nullptr;  ///< null: the floor has no colours of its own
  Matrix4 light_from_camera{};
  float shadow_texel = 0;  ///< [m]; 0: no shadows
  const ShadowMap* shadows = nullptr;
};

/// Samples of some rows: depths and numbers of surfaces. Arrays begin with sample 0 of the first
/// row, then sample 1; lines of `stride` have room for eight more than the picture is wide.
struct Samples {
  unsigned width = 0, first_row = 0, rows = 0;  ///< [px]
  std::size_t stride = 0;
  std::vector<float> depths;
  std::vector<std::uint32_t> numbers;

  std::size_t line(unsigned row, unsigned sample) const {
    return (std::size_t{row - first_row} * 4 + sample) * stride;
  }
};

/// Colours of a row of pixels, 0 to 255, as sums over their samples; with room as Samples.
struct RowColors {
  float *red, *green, *blue;
};

/// Pixels of a row, some of whose samples show one surface.
struct Run {
  std::uint32_t number;
  unsigned begin, end;  ///< [px]
};

struct Kernel {
  const char* name;
  /// Gives a polygon the samples in which it is nearest.
  void (*draw)(const Polygon& polygon, Samples& samples);
  /// Gives the floor those of a row.
  void (*lay_floor)(const Frame& frame, unsigned row, Samples& samples);
  /// Adds the colours of a run, by the number of its samples in each pixel.
  /// @param surface  null: of the sky or the floor
  void (*shade)(const Frame& frame, const Surface* surface, unsigned row, const Run& run,
                const Samples& samples, const RowColors& colors);
};

/// For any processor.
const Kernel& baseline_kernel();
/// Nothing where the processor has no AVX2.
const Kernel* avx2_kernel();

}  // namespace ziggurat::render
