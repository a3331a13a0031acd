// SPDX-License-Identifier: MIT
#pragma once
// A camera of a robot, with detectors for LEDs, directional LEDs and tags.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ziggurat/actuators.h"
#include "ziggurat/radio.h"

namespace ziggurat {

/// A pinhole camera. A point at (X, Y, Z) in its frame, +z forward, +x right, +y down, is seen at
/// u = fx X/Z + cx, v = fy Y/Z + cy: real pixels from the image's top left corner, u to the right,
/// v down. A handle into its session, valid while the session lives; readings and pictures are
/// valid until the session's next().
class Camera {
 public:
  using Pixel = std::array<double, 2>;  ///< u, v [px]

  struct LedReading {
    Color color;
    Pixel center{};
  };
  struct TagReading {
    std::string_view payload;  ///< any bytes
    Pixel center{};
    /// Corners (-,-), (-,+), (+,+), (+,-) half a side in the tag's frame.
    std::array<Pixel, 4> corners{};
  };

  const std::string& id() const noexcept { return id_; }
  /// Id of the link that carries it, or `origin`.
  const std::string& anchor() const noexcept { return anchor_; }
  /// In the anchor's frame: x, y, z [m].
  const std::array<double, 3>& position() const noexcept { return position_; }
  /// Unit quaternion w, x, y, z, camera to anchor.
  const std::array<double, 4>& orientation() const noexcept { return orientation_; }
  double near() const noexcept { return near_; }  ///< along the optical axis [m]
  double far() const noexcept { return far_; }    ///< along the optical axis [m]
  const Pixel& focal_length() const noexcept { return focal_length_; }        ///< fx, fy
  const Pixel& principal_point() const noexcept { return principal_point_; }  ///< cx, cy
  std::uint32_t width() const noexcept { return width_; }                     ///< [px]
  std::uint32_t height() const noexcept { return height_; }                   ///< [px]

  // Its detectors. The list of readings is empty at tick 0, and always without the detector.
  bool detects_leds() const noexcept { return detects_leds_; }
  bool detects_directional_leds() const noexcept { return detects_directional_leds_; }
  bool detects_tags() const noexcept { return detects_tags_; }
  /// Seen at this tick, each in scene order.
  std::span<const LedReading> leds() const noexcept { return leds_; }
  std::span<const LedReading> directional_leds() const noexcept { return directional_leds_; }
  std::span<const TagReading> tags() const noexcept { return tags_; }

  bool takes_images() const noexcept { return takes_images_; }
  /// width() x height() x 3 bytes: rows from the top, pixels from the left, red, green, blue.
  /// Empty at tick 0, and always if takes_images() is false.
  Bytes image() const noexcept { return image_; }

 private:
  friend struct Layout;
  std::string id_;
  std::string anchor_;
  std::array<double, 3> position_{};
  std::array<double, 4> orientation_{1, 0, 0, 0};
  double near_ = 0, far_ = 0;
  Pixel focal_length_{};
  Pixel principal_point_{};
  std::uint32_t width_ = 0, height_ = 0;
  bool detects_leds_ = false;
  bool detects_directional_leds_ = false;
  bool detects_tags_ = false;
  bool takes_images_ = false;
  std::vector<LedReading> leds_;
  std::vector<LedReading> directional_leds_;
  std::vector<TagReading> tags_;  // payloads and image: into the session's observation
  Bytes image_;
};

}  // namespace ziggurat
