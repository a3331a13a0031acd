#include "outputs/png.h"

#include <fmt/format.h>
#include <png.h>

#include "outputs/output_file.h"

namespace ziggurat::outputs {

std::string to_png(unsigned width, unsigned height, std::span<const std::uint8_t> rgb, bool fast) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = PNG_FORMAT_RGB;
  if (fast) image.flags = PNG_IMAGE_FLAG_FAST;
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
  const std::string bytes = to_png(width, height, rgb, false);
  file.buffer().append(bytes.data(), bytes.data() + bytes.size());
  file.close();
}

}  // namespace ziggurat::outputs
