#pragma once
// Pictures as PNG files.

#include <cstdint>
#include <span>
#include <string>

namespace ziggurat::outputs {

/// The bytes of a PNG file.
/// @param rgb  width * height * 3 bytes, rows from top to bottom
/// @param fast  a third of the time, and somewhat longer
/// @throws WriteError
std::string to_png(unsigned width, unsigned height, std::span<const std::uint8_t> rgb, bool fast);

/// @param rgb  width * height * 3 bytes, rows from top to bottom
/// @throws WriteError
void write_png(const std::string& path, unsigned width, unsigned height,
               std::span<const std::uint8_t> rgb);

}  // namespace ziggurat::outputs
