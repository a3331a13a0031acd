// SPDX-License-Identifier: MIT
// Finds AprilTags of the family 36h11 in a picture, by libapriltag: their numbers, one a line.
//
// usage: find_tags PICTURE.pgm

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include <cstdint>
#include <cstdio>
#include <vector>

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: find_tags PICTURE.pgm\n", stderr);
    return 1;
  }
  // A plain header, P5\nWIDTH HEIGHT\n255\n, then a byte per pixel.
  std::FILE* file = std::fopen(arguments[1], "rb");
  int width = 0, height = 0;
  if (!file || std::fscanf(file, "P5 %d %d 255", &width, &height) != 2 ||
      std::fgetc(file) != '\n' || width < 1 || height < 1 || width > 10000 || height > 10000) {
    std::fprintf(stderr, "%s is no picture in the format PGM\n", arguments[1]);
    return 1;
  }
  std::vector<std::uint8_t> grey(static_cast<std::size_t>(width) * height);
  if (std::fread(grey.data(), 1, grey.size(), file) != grey.size()) {
    std::fprintf(stderr, "%s is too short\n", arguments[1]);
    return 1;
  }
  std::fclose(file);
  image_u8_t picture{width, height, width, grey.data()};
  apriltag_family_t* family = tag36h11_create();
  apriltag_detector_t* detector = apriltag_detector_create();
  apriltag_detector_add_family_bits(detector, family, 0);
  detector->quad_decimate = 1;
  zarray_t* found = apriltag_detector_detect(detector, &picture);
  for (int i = 0; i < zarray_size(found); ++i) {
    apriltag_detection_t* one = nullptr;
    zarray_get(found, i, &one);
    std::printf("%d\n", one->id);
  }
  apriltag_detections_destroy(found);
  apriltag_detector_destroy(detector);
  tag36h11_destroy(family);
}
