#include "recording/png.h"

#include <png.h>

#include <cstddef>
#include <vector>

#include "recording/output_file.h"

namespace ziggurat::recording {

void write_png(const std::string& path, unsigned width, unsigned height,
               std::span<const std::uint8_t> rgb) {
  OutputFile file(path);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = PNG_FORMAT_RGB;
  std::vector<char> bytes(PNG_IMAGE_PNG_SIZE_MAX(image));
  png_alloc_size_t size = bytes.size();
  if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, rgb.data(), 0, nullptr)) {
    throw WriteError(fmt::format("{}: cannot be written: {}", path, image.message));
  }
  file.buffer().append(bytes.data(), bytes.data() + size);
  file.close();
}

}  // namespace ziggurat::recording
