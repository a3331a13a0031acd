#include "session_cameras.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "expect.h"

namespace ziggurat {
namespace {

using Doubles = google::protobuf::RepeatedField<double>;
using Integers = google::protobuf::RepeatedField<std::uint32_t>;

std::size_t size(int count) { return static_cast<std::size_t>(count); }

template <std::size_t n>
void copy(const Doubles& from, std::array<double, n>& to) {
  std::copy_n(from.begin(), std::min<std::size_t>(n, size(from.size())), to.begin());
}

/// As many readings as the cameras count.
std::size_t check_counts(const Integers& counts, std::size_t cameras, const char* what) {
  expect(size(counts.size()), cameras, what);
  std::size_t sum = 0;
  for (const std::uint32_t count : counts) sum += count;
  return sum;
}

Color color_of(std::uint32_t packed) {
  return {static_cast<std::uint8_t>(packed >> 16), static_cast<std::uint8_t>(packed >> 8),
          static_cast<std::uint8_t>(packed)};
}

}  // namespace

void Session::Cameras::add(const v1::RobotDescription& description, Robot& robot) {
  robot.cameras_.resize(size(description.cameras_size()));
  for (std::size_t i = 0; i < robot.cameras_.size(); ++i) {
    const v1::CameraDescription& from = description.cameras(static_cast<int>(i));
    Camera& camera = robot.cameras_[i];
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
    if (from.detects_leds()) leds_.push_back(&camera);
    if (from.detects_directional_leds()) directional_leds_.push_back(&camera);
    if (from.detects_tags()) tags_.push_back(&camera);
    if (from.image()) images_.push_back(&camera);
  }
}

void Session::Cameras::check(const v1::Observation& from) const {
  constexpr std::size_t numbers_of_corners = 8;
  const std::size_t leds = check_counts(from.led_counts(), leds_.size(), "counts of LEDs");
  expect(size(from.led_colors_size()), leds, "colors of LEDs seen");
  expect(size(from.led_centers_size()), 2 * leds, "numbers of centers of LEDs");
  const std::size_t directional = check_counts(
      from.directional_led_counts(), directional_leds_.size(), "counts of directional LEDs");
  expect(size(from.directional_led_colors_size()), directional, "colors of directional LEDs seen");
  expect(size(from.directional_led_centers_size()), 2 * directional,
         "numbers of centers of directional LEDs");
  const std::size_t tags = check_counts(from.tag_counts(), tags_.size(), "counts of tags");
  expect(size(from.tag_payloads_size()), tags, "payloads of tags seen");
  expect(size(from.tag_centers_size()), 2 * tags, "numbers of centers of tags");
  expect(size(from.tag_corners_size()), numbers_of_corners * tags, "numbers of corners of tags");
  expect(size(from.camera_images_size()), images_.size(), "pictures");
  for (std::size_t i = 0; i < images_.size(); ++i) {
    const std::string& image = from.camera_images(static_cast<int>(i));
    if (image.empty()) continue;
    // Announced, not believed: three times that many may be more than there are numbers.
    const std::size_t pixels = std::size_t{images_[i]->width()} * images_[i]->height();
    constexpr std::size_t most = std::numeric_limits<std::size_t>::max() / 3;
    expect(image.size(), 3 * std::min(pixels, most), "bytes of a picture");
  }
}

void Session::Cameras::read(const v1::Observation& from) {
  read_leds(leds_, &Camera::leds_, from.led_counts(), from.led_colors(), from.led_centers().data());
  read_leds(directional_leds_, &Camera::directional_leds_, from.directional_led_counts(),
            from.directional_led_colors(), from.directional_led_centers().data());
  read_tags(from);
  for (std::size_t i = 0; i < images_.size(); ++i) {
    const std::string& image = from.camera_images(static_cast<int>(i));
    images_[i]->image_ = {reinterpret_cast<const std::uint8_t*>(image.data()), image.size()};
  }
}

void Session::Cameras::read_leds(const std::vector<Camera*>& cameras,
                                 std::vector<Camera::LedReading> Camera::*readings,
                                 const Integers& counts, const Integers& colors,
                                 const double* center) {
  const std::uint32_t* color = colors.data();
  const std::uint32_t* count = counts.data();
  for (Camera* camera : cameras) {
    auto& seen = camera->*readings;
    seen.resize(*count++);
    for (Camera::LedReading& reading : seen) {
      reading.color = color_of(*color++);
      std::copy_n(center, 2, reading.center.begin());
      center += 2;
    }
  }
}

void Session::Cameras::read_tags(const v1::Observation& from) {
  const double* center = from.tag_centers().data();
  const double* corner = from.tag_corners().data();
  const std::uint32_t* count = from.tag_counts().data();
  int payload = 0;
  for (Camera* camera : tags_) {
    camera->tags_.resize(*count++);
    for (Camera::TagReading& reading : camera->tags_) {
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

}  // namespace ziggurat
