// SPDX-License-Identifier: MIT
#include <limits>

#include "layout.h"

namespace ziggurat {
namespace {

using Integers = google::protobuf::RepeatedField<std::uint32_t>;

/// The sum of the counts, one for each camera.
std::size_t check_counts(const Integers& counts, std::size_t cameras, const char* what) {
  expect(size(counts.size()), cameras, what);
  std::size_t sum = 0;
  for (const std::uint32_t count : counts) sum += count;
  return sum;
}

void read_leds(const std::vector<std::vector<Camera::LedReading>*>& cameras, const Integers& counts,
               const Integers& colors, const double* center) {
  const std::uint32_t* color = colors.data();
  const std::uint32_t* count = counts.data();
  for (std::vector<Camera::LedReading>* readings : cameras) {
    readings->resize(*count++);
    for (Camera::LedReading& reading : *readings) {
      reading.color = color_of(*color++);
      std::copy_n(center, 2, reading.center.begin());
      center += 2;
    }
  }
}

}  // namespace

/// Readings of a session's cameras. Each list holds the cameras that have the detector, or take
/// pictures, in Welcome's order.
struct CameraChannel final : Channel {
  struct Image {
    Bytes* bytes;
    std::size_t size;  // unless it is empty
  };
  std::vector<std::vector<Camera::LedReading>*> leds;
  std::vector<std::vector<Camera::LedReading>*> directional_leds;
  std::vector<std::vector<Camera::TagReading>*> tags;
  std::vector<Image> images;

  void check(const v1::Observation& from) const override;
  void read(const v1::Observation& from) override;
  void read_tags(const v1::Observation& from);
};

void CameraChannel::check(const v1::Observation& from) const {
  constexpr std::size_t numbers_of_corners = 8;
  const std::size_t led_count = check_counts(from.led_counts(), leds.size(), "counts of LEDs");
  expect(size(from.led_colors_size()), led_count, "colors of LEDs seen");
  expect(size(from.led_centers_size()), 2 * led_count, "numbers of centers of LEDs");
  const std::size_t directional_count = check_counts(
      from.directional_led_counts(), directional_leds.size(), "counts of directional LEDs");
  expect(size(from.directional_led_colors_size()), directional_count,
         "colors of directional LEDs seen");
  expect(size(from.directional_led_centers_size()), 2 * directional_count,
         "numbers of centers of directional LEDs");
  const std::size_t tag_count = check_counts(from.tag_counts(), tags.size(), "counts of tags");
  expect(size(from.tag_payloads_size()), tag_count, "payloads of tags seen");
  expect(size(from.tag_centers_size()), 2 * tag_count, "numbers of centers of tags");
  expect(size(from.tag_corners_size()), numbers_of_corners * tag_count,
         "numbers of corners of tags");
  expect(size(from.camera_images_size()), images.size(), "pictures");
  for (std::size_t i = 0; i < images.size(); ++i) {
    const std::string& image = from.camera_images(static_cast<int>(i));
    if (!image.empty()) expect(image.size(), images[i].size, "bytes of a picture");
  }
}

void CameraChannel::read(const v1::Observation& from) {
  read_leds(leds, from.led_counts(), from.led_colors(), from.led_centers().data());
  read_leds(directional_leds, from.directional_led_counts(), from.directional_led_colors(),
            from.directional_led_centers().data());
  read_tags(from);
  for (std::size_t i = 0; i < images.size(); ++i) {
    *images[i].bytes = bytes_of(from.camera_images(static_cast<int>(i)));
  }
}

void CameraChannel::read_tags(const v1::Observation& from) {
  const double* center = from.tag_centers().data();
  const double* corner = from.tag_corners().data();
  const std::uint32_t* count = from.tag_counts().data();
  int payload = 0;
  for (std::vector<Camera::TagReading>* readings : tags) {
    readings->resize(*count++);
    for (Camera::TagReading& reading : *readings) {
      reading.payload = from.tag_payloads(payload++);
      std::copy_n(center, 2, reading.center.begin());
      center += 2;
      for (Camera::Pixel& pixel : reading.corners) {
        std::copy_n(corner, 2, pixel.begin());
        corner += 2;
      }
    }
  }
}

void Layout::add_cameras() {
  auto& channel = add(CameraChannel());
  each_robot([&](const v1::RobotDescription& robot, Robot& to) {
    to.cameras_.reserve(size(robot.cameras_size()));
    for (const v1::CameraDescription& from : robot.cameras()) {
      Camera& camera = to.cameras_.emplace_back();
      camera.id_ = from.id();
      camera.anchor_ = from.anchor();
      copy(from.position(), camera.position_);
      copy(from.orientation(), camera.orientation_);
      camera.near_ = from.near();
      camera.far_ = from.far();
      copy(from.focal_length(), camera.focal_length_);
      copy(from.principal_point(), camera.principal_point_);
      camera.width_ = from.width();
      camera.height_ = from.height();
      camera.detects_leds_ = from.detects_leds();
      camera.detects_directional_leds_ = from.detects_directional_leds();
      camera.detects_tags_ = from.detects_tags();
      camera.takes_images_ = from.image();
      if (from.detects_leds()) channel.leds.push_back(&camera.leds_);
      if (from.detects_directional_leds()) {
        channel.directional_leds.push_back(&camera.directional_leds_);
      }
      if (from.detects_tags()) channel.tags.push_back(&camera.tags_);
      // The numbers are the server's: their product may be more than a size can hold.
      constexpr std::size_t max_pixels = std::numeric_limits<std::size_t>::max() / 3;
      const std::size_t pixels = std::size_t{from.width()} * from.height();
      if (from.image())
        channel.images.push_back({&camera.image_, 3 * std::min(pixels, max_pixels)});
    }
  });
}

}  // namespace ziggurat
