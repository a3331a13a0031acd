// SPDX-License-Identifier: MIT
#pragma once
// Pictures as PNG files: of any content, and those of robots' cameras.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "world/layout.h"
#include "world/state.h"

namespace ziggurat::outputs {

/// Encoding of a picture: fast takes a third of the time, and its files are somewhat longer.
enum class PngEncoding { small, fast };

/// The bytes of a PNG file.
/// @param rgb  width * height * 3 bytes, rows from top to bottom
/// @throws WriteError
std::string to_png(unsigned width, unsigned height, std::span<const std::uint8_t> rgb,
                   PngEncoding encoding);

/// @param rgb  width * height * 3 bytes, rows from top to bottom
/// @throws WriteError
void write_png(const std::string& path, unsigned width, unsigned height,
               std::span<const std::uint8_t> rgb);

/// `robot.camera.000123.png`. In ids, bytes other than letters, digits, `-` or `_` become `%` and
/// two hexadecimal digits. So any two ids differ, and none leaves the folder.
std::string image_name(std::string_view robot, std::string_view camera, std::uint64_t tick);

/// Pictures of robots' cameras, one file per camera and tick.
class Images {
 public:
  /// Makes the folder if it isn't there. @param layout  has to outlive this
  /// @throws WriteError
  Images(std::string folder, const world::Layout& layout);

  /// Nothing for pictures that are empty, as those of tick 0. @throws WriteError
  void write(const world::Observations& observations);

 private:
  std::string folder_;
  const world::Layout& layout_;
};

}  // namespace ziggurat::outputs
