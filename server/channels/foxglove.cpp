// SPDX-License-Identifier: MIT
#include "channels/foxglove.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "outputs/images.h"

namespace ziggurat::channels {
namespace {

using foxglove::Point3;
using foxglove::SceneEntity;

constexpr double frustum_alpha = 0.85;

template <class To>
void set(double x, double y, double z, To& to) {
  to.set_x(x);
  to.set_y(y);
  to.set_z(z);
}
template <class To>
void set(const math::Vector3& from, To& to) {
  set(from.x(), from.y(), from.z(), to);
}
void set(const math::Quaternion& from, foxglove::Quaternion& to) {
  set(from.x(), from.y(), from.z(), to);
  to.set_w(from.w());
}

/// At a height above the frame's origin.
void set_pose(double height, foxglove::Pose& to) {
  set(0, 0, height, *to.mutable_position());
  to.mutable_orientation()->set_w(1);
}

void add_cylinder(double radius, double base, double height, const foxglove::Color& color,
                  SceneEntity& to) {
  foxglove::CylinderPrimitive& cylinder = *to.add_cylinders();
  set_pose(base + height / 2, *cylinder.mutable_pose());
  set(2 * radius, 2 * radius, height, *cylinder.mutable_size());
  cylinder.set_bottom_scale(1);
  cylinder.set_top_scale(1);
  *cylinder.mutable_color() = color;
}

void add_sphere(double radius, double center, const foxglove::Color& color, SceneEntity& to) {
  foxglove::SpherePrimitive& sphere = *to.add_spheres();
  set_pose(center, *sphere.mutable_pose());
  set(2 * radius, 2 * radius, 2 * radius, *sphere.mutable_size());
  *sphere.mutable_color() = color;
}

void add_hull(const v1::World::Hull& hull, const foxglove::Color& color, SceneEntity& to) {
  foxglove::TriangleListPrimitive& mesh = *to.add_triangles();
  set_pose(0, *mesh.mutable_pose());
  for (int i = 0; i + 2 < hull.vertices_size(); i += 3) {
    set(hull.vertices(i), hull.vertices(i + 1), hull.vertices(i + 2), *mesh.add_points());
  }
  for (const std::uint32_t corner : hull.triangles()) mesh.add_indices(corner);
  *mesh.mutable_color() = color;
}

void add_shape(const v1::World& world, const v1::World::Link& link, SceneEntity& to) {
  const foxglove::Color color = color_of(link.color());
  if (link.has_box()) {
    foxglove::CubePrimitive& cube = *to.add_cubes();
    const auto& size = link.box().size();
    set_pose(size[2] / 2, *cube.mutable_pose());
    set(size[0], size[1], size[2], *cube.mutable_size());
    *cube.mutable_color() = color;
  } else if (link.has_cylinder()) {
    add_cylinder(link.cylinder().radius(), 0, link.cylinder().height(), color, to);
  } else if (link.has_sphere()) {
    add_sphere(link.sphere().radius(), link.sphere().radius(), color, to);
  } else if (link.has_capsule()) {
    const double r = link.capsule().radius(), height = link.capsule().height();
    if (height > 2 * r) add_cylinder(r, r, height - 2 * r, color, to);
    add_sphere(r, r, color, to);
    add_sphere(r, height - r, color, to);
  } else if (link.shape_case() == v1::World::Link::kHull) {
    add_hull(world.hulls(static_cast<int>(link.hull())), color, to);
  }
}

void add_label(const std::string& text, SceneEntity& to) {
  foxglove::TextPrimitive& label = *to.add_texts();
  set_pose(0.05, *label.mutable_pose());
  label.set_billboard(true);
  label.set_font_size(14);
  label.set_scale_invariant(true);
  *label.mutable_color() = color_of(0x202020);
  label.set_text(text);
}

/// The corners of a picture at a depth, in the camera's frame.
std::array<math::Vector3, 4> corners_at(const v1::World::Camera& camera, double depth) {
  const auto ray = [&](double u, double v) {
    return math::Vector3(depth * (u - camera.principal_point(0)) / camera.focal_length(0),
                         depth * (v - camera.principal_point(1)) / camera.focal_length(1), depth);
  };
  const double width = camera.width(), height = camera.height();
  return {ray(0, 0), ray(width, 0), ray(width, height), ray(0, height)};
}

void add_frustum(const v1::World::Camera& camera, SceneEntity& to) {
  foxglove::LinePrimitive& lines = *to.add_lines();
  lines.set_type(foxglove::LinePrimitive::LINE_LIST);
  set_pose(0, *lines.mutable_pose());
  lines.set_thickness(1);
  lines.set_scale_invariant(true);
  *lines.mutable_color() = color_of(0xc08a20, frustum_alpha);
  const auto near = corners_at(camera, camera.near()), far = corners_at(camera, camera.far());
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t next = (i + 1) % 4;
    for (const auto& point : {near[i], near[next], far[i], far[next], near[i], far[i]}) {
      set(point, *lines.add_points());
    }
  }
}

/// An entity that stays until it is replaced.
SceneEntity& begin_entity(const std::string& frame, std::int64_t time_ns,
                          foxglove::SceneUpdate& to) {
  SceneEntity& entity = *to.add_entities();
  set_time(time_ns, *entity.mutable_timestamp());
  entity.set_frame_id(frame);
  entity.set_id(frame);
  entity.mutable_lifetime();
  entity.set_frame_locked(true);
  return entity;
}

bool is_removed(const v1::World& world, std::uint32_t entity) {
  return world.entities(static_cast<int>(entity)).removed();
}

}  // namespace

void set_time(std::int64_t time_ns, google::protobuf::Timestamp& to) {
  to.set_seconds(time_ns / 1'000'000'000);
  to.set_nanos(static_cast<std::int32_t>(time_ns % 1'000'000'000));
}

foxglove::Color color_of(std::uint32_t rgb, double alpha) {
  foxglove::Color color;
  color.set_r(((rgb >> 16) & 0xff) / 255.0);
  color.set_g(((rgb >> 8) & 0xff) / 255.0);
  color.set_b((rgb & 0xff) / 255.0);
  color.set_a(alpha);
  return color;
}

std::string camera_frame(const v1::World& world, const v1::World::Camera& camera) {
  const auto& robot = world.robots(static_cast<int>(camera.robot()));
  return world.entities(static_cast<int>(robot.entity())).id() + "/cameras/" + camera.id();
}

foxglove::SceneUpdate scene_update(const v1::World& world, const Layers& layers,
                                   std::int64_t time_ns) {
  foxglove::SceneUpdate update;
  foxglove::SceneEntityDeletion& all = *update.add_deletions();
  set_time(time_ns, *all.mutable_timestamp());
  all.set_type(foxglove::SceneEntityDeletion::ALL);
  for (int i = 0; i < world.links_size(); ++i) {
    const v1::World::Link& link = world.links(i);
    if (is_removed(world, link.entity())) continue;
    SceneEntity& entity = begin_entity(link.frame(), time_ns, update);
    if (link.collides()) add_shape(world, link, entity);
    const auto& own = world.entities(static_cast<int>(link.entity()));
    if (layers.labels && own.reference_link() == static_cast<std::uint32_t>(i)) {
      add_label(own.id(), entity);
    }
  }
  for (const v1::World::Camera& camera : world.cameras()) {
    const std::uint32_t entity = world.robots(static_cast<int>(camera.robot())).entity();
    if (!layers.frusta || is_removed(world, entity)) continue;
    add_frustum(camera, begin_entity(camera_frame(world, camera), time_ns, update));
  }
  return update;
}

foxglove::FrameTransforms frames_of(const v1::World& world) {
  foxglove::FrameTransforms frames;
  for (const v1::World::Link& link : world.links()) {
    foxglove::FrameTransform& frame = *frames.add_transforms();
    frame.set_parent_frame_id("world");
    frame.set_child_frame_id(link.frame());
  }
  for (const v1::World::Camera& camera : world.cameras()) {
    foxglove::FrameTransform& frame = *frames.add_transforms();
    frame.set_parent_frame_id(world.links(static_cast<int>(camera.mount().link())).frame());
    frame.set_child_frame_id(camera_frame(world, camera));
    const auto &at = camera.mount().position(), &turned = camera.mount().orientation();
    set(at[0], at[1], at[2], *frame.mutable_translation());
    set(math::Quaternion(turned[0], turned[1], turned[2], turned[3]), *frame.mutable_rotation());
  }
  return frames;
}

void fill(const Moment& from, foxglove::FrameTransforms& to) {
  for (int i = 0; i < to.transforms_size(); ++i) {
    foxglove::FrameTransform& frame = *to.mutable_transforms(i);
    set_time(from.state.time_ns, *frame.mutable_timestamp());
    const auto link = static_cast<std::size_t>(i);
    if (link >= from.state.links.size()) continue;  // a camera
    set(from.state.links[link].pose.position, *frame.mutable_translation());
    set(from.state.links[link].pose.orientation, *frame.mutable_rotation());
  }
}

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
