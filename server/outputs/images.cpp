// SPDX-License-Identifier: MIT
#include "outputs/images.h"

#include <fmt/format.h>
#include <png.h>

#include <filesystem>
#include <utility>

#include "outputs/output_file.h"
#include "outputs/reading.h"

namespace ziggurat::outputs {
namespace {

std::string for_file_name(std::string_view id) {
  std::string name;
  for (const char character : id) {
    const bool plain =
        (character >= 'a' && character <= 'z') || (character >= 'A' && character <= 'Z') ||
        (character >= '0' && character <= '9') || character == '-' || character == '_';
    if (plain) {
      name += character;
    } else {
      name += fmt::format("%{:02X}", static_cast<unsigned char>(character));
    }
  }
  return name;
}

}  // namespace

std::string to_png(unsigned width, unsigned height, std::span<const std::uint8_t> rgb,
                   PngEncoding encoding) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = PNG_FORMAT_RGB;
  if (encoding == PngEncoding::fast) image.flags = PNG_IMAGE_FLAG_FAST;
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
  png_alloc_size_t size = bytes.size();
  if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, rgb.data(), 0, nullptr)) {
    throw WriteError(fmt::format("a picture of {} x {} pixels cannot be encoded: {}", width, height,
                                 image.message));
  }
  bytes.resize(size);
  return bytes;
}

void write_png(const std::string& path, unsigned width, unsigned height,
               std::span<const std::uint8_t> rgb) {
  OutputFile file(path);
  const std::string bytes = to_png(width, height, rgb, PngEncoding::small);
  file.buffer().append(bytes.data(), bytes.data() + bytes.size());
  file.close();
}

std::string image_name(std::string_view robot, std::string_view camera, std::uint64_t tick) {
  return fmt::format("{}.{}.{:06}.png", for_file_name(robot), for_file_name(camera), tick);
}

Images::Images(std::string folder, const world::Layout& layout)
    : folder_(std::move(folder)), layout_(layout) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throw WriteError(fmt::format("{}: cannot be made: {}", folder_, error.message()));
}

void Images::write(const world::Observations& observations) {
  for (const world::Image& image : observations.images) {
    if (image.rgb.empty()) continue;
    const world::CameraLayout& camera = layout_.cameras[image.camera];
    const std::string& robot = robot_with(image.camera, layout_).id;
    const auto path =
        std::filesystem::path(folder_) / image_name(robot, camera.id, observations.tick);
    write_png(path.string(), camera.resolution[0], camera.resolution[1], image.rgb);
  }
}

}  // namespace ziggurat::outputs
