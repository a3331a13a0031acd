// SPDX-License-Identifier: MIT
#pragma once
// The real tag detector, libapriltag, on a picture.

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include <array>
#include <memory>
#include <vector>

#include "render/view.h"

namespace ziggurat::render::testing {

struct Detection {
  int id;
  std::array<math::Vector2, 4> corners;  ///< 1, 2, 3, 4 in the order of tag readings [px]
};

class Detector {
 public:
  Detector() : family_(tag36h11_create()), detector_(apriltag_detector_create()) {
    apriltag_detector_add_family_bits(detector_, family_, 1);
    detector_->quad_decimate = 1;
    detector_->nthreads = 1;
  }
  ~Detector() {
    apriltag_detector_destroy(detector_);
    tag36h11_destroy(family_);
  }
  Detector(const Detector&) = delete;
  Detector& operator=(const Detector&) = delete;

  std::vector<Detection> detect(const Picture& picture) {
    std::vector<std::uint8_t> grey(std::size_t{picture.width} * picture.height);
    for (std::size_t i = 0; i < grey.size(); ++i) {
      const std::uint8_t* rgb = &picture.rgb[3 * i];
      grey[i] = static_cast<std::uint8_t>((299 * rgb[0] + 587 * rgb[1] + 114 * rgb[2]) / 1000);
    }
    image_u8_t image{static_cast<int32_t>(picture.width), static_cast<int32_t>(picture.height),
                     static_cast<int32_t>(picture.width), grey.data()};
    zarray_t* found = apriltag_detector_detect(detector_, &image);
    std::vector<Detection> detections;
    for (int i = 0; i < zarray_size(found); ++i) {
      apriltag_detection_t* each = nullptr;
      zarray_get(found, i, &each);
      Detection detection{each->id, {}};
      constexpr std::array<std::size_t, 4> theirs{1, 0, 3, 2};  // docs/conventions.md
      for (std::size_t c = 0; c < 4; ++c) {
        detection.corners[c] = {each->p[theirs[c]][0], each->p[theirs[c]][1]};
      }
      detections.push_back(detection);
    }
    apriltag_detections_destroy(found);
    return detections;
  }

 private:
  apriltag_family_t* family_;
  apriltag_detector_t* detector_;
};

}  // namespace ziggurat::render::testing
