// SPDX-License-Identifier: MIT
#include "images/image.h"

#include <fmt/format.h>
#include <png.h>

#include <charconv>
#include <cmath>

namespace ziggurat::images {
namespace {

std::string too_many_pixels(unsigned width, unsigned height) {
  return fmt::format("has {} x {} pixels; write one with at most {}", width, height, most_pixels);
}

bool has_right_size(unsigned width, unsigned height) {
  return width > 0 && height > 0 && height <= most_pixels / width;
}

std::variant<Image, std::string> read_png(std::string_view bytes) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0) {
    return fmt::format("is no readable PNG file ({}); save it anew", png.message);
  }
  if (!has_right_size(png.width, png.height)) {
    png_image_free(&png);
    return too_many_pixels(png.width, png.height);
  }
  png.format = PNG_FORMAT_RGBA;  // transparent pixels have their colour, too
  std::vector<std::uint8_t> pixels(std::size_t{4} * png.width * png.height);
  if (png_image_finish_read(&png, nullptr, pixels.data(), 0, nullptr) == 0) {
    return fmt::format("is no readable PNG file ({}); save it anew", png.message);
  }
  Image image{png.width, png.height, {}};
  image.rgb.reserve(pixels.size() / 4 * 3);
  for (std::size_t i = 0; i < pixels.size(); i += 4) {
    image.rgb.insert(image.rgb.end(), &pixels[i], &pixels[i] + 3);
  }
  return image;
}

/// The header of a portable anymap: its next number, after white space and comments.
std::optional<unsigned> take_number(std::string_view& text) {
  for (;;) {
    const std::size_t begin = text.find_first_not_of(" \t\r\n");
    text.remove_prefix(std::min(begin, text.size()));
    if (!text.starts_with('#')) break;
    text.remove_prefix(std::min(text.find('\n'), text.size()));
  }
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{}) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

std::variant<Image, std::string> read_anymap(std::string_view bytes) {
  const std::size_t channels = bytes[1] == '6' ? 3 : 1;
  bytes.remove_prefix(2);
  const auto width = take_number(bytes), height = take_number(bytes), most = take_number(bytes);
  if (!width || !height || most != 255u || bytes.empty()) {
    return "is no PPM or PGM file with values up to 255; save it as PNG";
  }
  bytes.remove_prefix(1);
  if (!has_right_size(*width, *height)) return too_many_pixels(*width, *height);
  const std::size_t pixels = std::size_t{*width} * *height;
  if (bytes.size() < channels * pixels) return "ends before its last pixel; save it anew";
  Image image{*width, *height, {}};
  image.rgb.reserve(3 * pixels);
  for (std::size_t i = 0; i < 3 * pixels; ++i) {
    image.rgb.push_back(static_cast<std::uint8_t>(bytes[channels == 3 ? i : i / 3]));
  }
  return image;
}

/// Pixel of a place on a side of the rectangle; none outside.
std::optional<std::size_t> pixel(double place, double center, double size, unsigned pixels) {
  const double at = std::floor(((place - center) / size + 0.5) * pixels);
  if (!(at >= 0 && at < pixels)) return std::nullopt;
  return static_cast<std::size_t>(at);
}

}  // namespace

std::optional<std::uint32_t> color_at(const Image& image, const Rectangle& covered, double x,
                                      double y) {
  const auto column = pixel(x, covered.center[0], covered.size[0], image.width);
  const auto row = pixel(y, covered.center[1], covered.size[1], image.height);
  if (!column || !row) return std::nullopt;
  const std::uint8_t* const rgb =
      &image.rgb[3 * ((image.height - 1 - *row) * image.width + *column)];
  return std::uint32_t{rgb[0]} << 16 | std::uint32_t{rgb[1]} << 8 | rgb[2];
}

std::variant<Image, std::string> read_image(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG")) return read_png(bytes);
  if (bytes.starts_with("P5") || bytes.starts_with("P6")) return read_anymap(bytes);
  return "is no PNG, PPM or PGM file; convert it to PNG";
}

}  // namespace ziggurat::images
