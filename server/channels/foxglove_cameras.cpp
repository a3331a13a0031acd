#include "channels/foxglove_cameras.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "channels/foxglove_scene.h"
#include "outputs/images.h"

namespace ziggurat::channels {
namespace {

constexpr double led_diameter = 12;  // of the circle about a detected LED [px]
constexpr double thickness = 2;      // of outlines [px]
constexpr double font_size = 14;     // [px]
constexpr std::uint32_t tag_color = 0x30d158;

void set_point(const math::Vector2& from, foxglove::Point2& to) {
  to.set_x(from.x());
  to.set_y(from.y());
}

void add_led(const world::LedReading& led, std::int64_t time_ns, foxglove::ImageAnnotations& to) {
  foxglove::CircleAnnotation& circle = *to.add_circles();
  set_time(time_ns, *circle.mutable_timestamp());
  set_point(led.center, *circle.mutable_position());
  circle.set_diameter(led_diameter);
  circle.set_thickness(thickness);
  *circle.mutable_outline_color() = color_of(led.color);
  *circle.mutable_fill_color() = color_of(led.color, 0);
}

void add_tag(const world::TagReading& tag, const std::string& payload, std::int64_t time_ns,
             foxglove::ImageAnnotations& to) {
  foxglove::PointsAnnotation& outline = *to.add_points();
  set_time(time_ns, *outline.mutable_timestamp());
  outline.set_type(foxglove::PointsAnnotation::LINE_LOOP);
  for (const auto& corner : tag.corners) set_point(corner, *outline.add_points());
  *outline.mutable_outline_color() = color_of(tag_color);
  *outline.mutable_fill_color() = color_of(tag_color, 0);
  outline.set_thickness(thickness);
  foxglove::TextAnnotation& text = *to.add_texts();
  set_time(time_ns, *text.mutable_timestamp());
  set_point(tag.center, *text.mutable_position());
  text.set_text(v1::valid_utf8(payload));
  text.set_font_size(font_size);
  *text.mutable_text_color() = color_of(tag_color);
  *text.mutable_background_color() = color_of(0, 0.5);
}

}  // namespace

foxglove::CameraCalibration calibration_of(const v1::World& world, std::size_t place,
                                           std::int64_t time_ns) {
  const v1::World::Camera& camera = world.cameras(static_cast<int>(place));
  const double fx = camera.focal_length(0), fy = camera.focal_length(1);
  const double cx = camera.principal_point(0), cy = camera.principal_point(1);
  foxglove::CameraCalibration calibration;
  set_time(time_ns, *calibration.mutable_timestamp());
  calibration.set_frame_id(camera_frame(world, camera));
  calibration.set_width(camera.width());
  calibration.set_height(camera.height());
  for (const double value : {fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0}) calibration.add_k(value);
  for (const double value : {1, 0, 0, 0, 1, 0, 0, 0, 1}) calibration.add_r(value);
  for (const double value : {fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0}) {
    calibration.add_p(value);
  }
  return calibration;
}

foxglove::ImageAnnotations annotations_of(std::size_t camera, const Moment& moment) {
  foxglove::ImageAnnotations annotations;
  const std::int64_t time_ns = moment.state.time_ns;
  set_time(time_ns, *annotations.mutable_timestamp());
  for (const auto* leds : {&moment.observations.leds, &moment.observations.directional_leds}) {
    for (const world::LedReading& led : *leds) {
      if (led.camera == camera) add_led(led, time_ns, annotations);
    }
  }
  for (const world::TagReading& tag : moment.observations.tags) {
    if (tag.camera != camera) continue;
    add_tag(tag, moment.state.tag_payloads[tag.tag], time_ns, annotations);
  }
  return annotations;
}

std::shared_ptr<const Content> picture_of(const v1::World& world, std::size_t camera,
                                          const Moment& moment) {
  const auto& images = moment.observations.images;
  const auto image = std::ranges::find(images, camera, &world::Image::camera);
  if (image == images.end() || image->rgb.empty()) return nullptr;
  const v1::World::Camera& described = world.cameras(static_cast<int>(camera));
  const auto encode = [frame = camera_frame(world, described), width = described.width(),
                       height = described.height(), time_ns = moment.state.time_ns,
                       rgb = image->rgb] {
    foxglove::CompressedImage picture;
    set_time(time_ns, *picture.mutable_timestamp());
    picture.set_frame_id(frame);
    picture.set_format("png");
    picture.set_data(outputs::to_png(width, height, rgb, outputs::PngEncoding::fast));
    return picture.SerializeAsString();
  };
  return std::make_shared<const Content>(encode, image->rgb.size());
}

}  // namespace ziggurat::channels
