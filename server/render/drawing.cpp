// SPDX-License-Identifier: MIT
#include "render/drawing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "render/tag36h11.h"
#include "scene/devices.h"

namespace ziggurat::render {
namespace {

using math::Pose;
using math::Vector3;

const Vector3 towards_sun = Vector3(-0.42, -0.62, 1.15).normalized();
constexpr double led_radius = 0.004;             // [m]
constexpr double least_led_radius = 1.5;         // [px]
constexpr double modules_per_side = 10.0 / 8.0;  // with the white margin, of a tag's side_length

/// A sphere around a link.
struct Ball {
  Vector3 center;  ///< [m]
  double radius;   ///< [m]
};

// The ball about a shape, in the link's frame:
Ball ball_of(const scene::Sphere& sphere) { return {{0, 0, sphere.radius}, sphere.radius}; }

template <class Shape>
Ball ball_of(const Shape& shape) {
  const scene::Bounds bounds = scene::bounds(shape);
  return {bounds.center(), bounds.size().norm() / 2};
}

/// Whether a ball in the camera's frame may show in the picture.
bool shows(const Ball& ball, const View& view) {
  const Vector3& p = ball.center;
  if (p.z() + ball.radius <= 0) return false;
  const auto beyond = [&](double along, double focal_length, double low, double high) {
    // The planes through the camera and the picture's edges, at u = 0 and u = size.
    const double left = (focal_length * along + low * p.z()) / std::hypot(focal_length, low);
    const double right = (-focal_length * along + high * p.z()) / std::hypot(focal_length, high);
    return left < -ball.radius || right < -ball.radius;
  };
  const double cx = view.principal_point.x(), cy = view.principal_point.y();
  return !beyond(p.x(), view.focal_length.x(), cx, view.width - cx) &&
         !beyond(p.y(), view.focal_length.y(), cy, view.height - cy);
}

/// The box around balls in the frame of the light: z towards the sun.
struct Bounds {
  Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity());
  Vector3 high = -low;

  void add(const Ball& ball) {
    low = low.cwiseMin(ball.center - Vector3::Constant(ball.radius));
    high = high.cwiseMax(ball.center + Vector3::Constant(ball.radius));
  }
};

math::Quaternion light_from_world() {
  // The shortest rotation of towards_sun onto +z. (Eigen's FromTwoVectors handles opposite vectors
  // by a singular value decomposition, which takes the compiler seven seconds.)
  const Vector3 axis = towards_sun.cross(Vector3::UnitZ());
  return math::Quaternion(1 + towards_sun.z(), axis.x(), axis.y(), axis.z()).normalized();
}

/// @param visible  of what is in view; z is bounded by `all`
void aim_light(const Bounds& visible, const Bounds& all, const View& view, Drawing& drawing) {
  drawing.sun = to_floats(view.camera.orientation.conjugate() * towards_sun);
  drawing.shadow_texel = 0;
  if (!(visible.low.x() < visible.high.x())) return;
  // A few texels of margin, and whole texels, so that shadows don't crawl when the view moves.
  const double side =
      std::max(visible.high.x() - visible.low.x(), visible.high.y() - visible.low.y());
  const double texel = side * 1.02 / shadow_size;
  const double left = std::floor((visible.low.x() - 0.01 * side) / texel) * texel;
  const double lower = std::floor((visible.low.y() - 0.01 * side) / texel) * texel;
  const double extent = texel * (shadow_size + 1);
  const double depth = all.high.z() - all.low.z();

  const math::Quaternion turn = light_from_world() * view.camera.orientation;
  const Vector3 eye = light_from_world() * view.camera.position;
  const Eigen::Matrix3d axes = turn.toRotationMatrix();
  Matrix4& m = drawing.light_from_camera;
  for (int column = 0; column < 3; ++column) {
    m[4 * column + 0] = static_cast<float>(axes(0, column) / extent);
    m[4 * column + 1] = static_cast<float>(axes(1, column) / extent);
    m[4 * column + 2] = static_cast<float>(-axes(2, column) / depth);
    m[4 * column + 3] = 0;
  }
  m[12] = static_cast<float>((eye.x() - left) / extent);
  m[13] = static_cast<float>((eye.y() - lower) / extent);
  m[14] = static_cast<float>((all.high.z() - eye.z()) / depth);
  m[15] = 1;
  drawing.shadow_texel = texel;
}

/// @param base  where the mesh stands, in the link's frame [m]
/// @param unit  how long one unit of the mesh is along the link's axes [m]
BodyInstance instance_of(const Pose& in_camera, const Rgb& color, const Vector3& base,
                         const Vector3& unit, const Vector3& size) {
  BodyInstance instance;
  const Eigen::Matrix3d axes = in_camera.orientation.toRotationMatrix();
  for (int i = 0; i < 3; ++i) {
    instance.axes[static_cast<std::size_t>(i)] = to_floats(Vector3(axes.col(i) * unit[i]));
  }
  instance.position = to_floats(in_camera * base);
  instance.size = to_floats(size);
  instance.color = to_floats(color);
  return instance;
}

Float3 channels(world::Color color) {
  return {static_cast<float>((color >> 16) & 0xff) / 255.0f,
          static_cast<float>((color >> 8) & 0xff) / 255.0f,
          static_cast<float>(color & 0xff) / 255.0f};
}

constexpr Float3 led_that_is_off{0.12f, 0.12f, 0.13f};

MarkInstance disc(const Vector3& center, const Vector3& x, const Vector3& y, world::Color color) {
  return {to_floats(center),
          to_floats(x),
          to_floats(y),
          color == 0 ? led_that_is_off : channels(color),
          {MarkInstance::disc, 0, 0}};
}

double led_radius_at(double depth, const View& view) {
  return std::max(led_radius, least_led_radius * depth / view.focal_length.minCoeff());
}

MarkInstance tag_mark(const Pose& in_camera, double side_length, const std::string& payload) {
  const Vector3 half(0.5 * modules_per_side * side_length, 0, 0);
  const Vector3 x = in_camera.orientation * half;
  const Vector3 y = in_camera.orientation * Vector3(0, half.x(), 0);
  MarkInstance mark{to_floats(in_camera.position), to_floats(x), to_floats(y), {}, {}};
  if (const auto id = scene::tag_pattern(payload)) {
    const std::uint64_t bits = tag36h11_patterns()[*id];
    mark.code = {MarkInstance::pattern, static_cast<std::uint32_t>(bits),
                 static_cast<std::uint32_t>(bits >> 32)};
  } else {
    mark.code = {MarkInstance::plain, 0, 0};
  }
  return mark;
}

}  // namespace

Draftsman::Draftsman(Model model, const world::Layout& layout)
    : model_(std::move(model)), layout_(layout), meshes_(make_meshes()) {
  mesh_of_bucket_.push_back(meshes_.box);
  for (const auto& mesh : meshes_.cylinders) mesh_of_bucket_.push_back(mesh);
  for (const auto& mesh : meshes_.spheres) mesh_of_bucket_.push_back(mesh);
  add_hulls(0);
}

void Draftsman::add(const scene::Entity& entity, std::size_t first_link) {
  const auto known = std::min(first_link, model_.bodies.size());
  model_.bodies.erase(model_.bodies.begin() + static_cast<std::ptrdiff_t>(known),
                      model_.bodies.end());
  render::add_bodies(entity, model_);
  add_hulls(known);
}

/// Gives the hulls among new bodies a mesh; those of a model share one.
void Draftsman::add_hulls(std::size_t first_body) {
  for (std::size_t i = first_body; i < model_.bodies.size(); ++i) {
    const auto* hull = std::get_if<scene::Hull>(&model_.bodies[i].geometry);
    if (!hull || !bucket_of_hull_.emplace(hull->polyhedron, mesh_of_bucket_.size()).second)
      continue;
    mesh_of_bucket_.push_back(add_hull(*hull->polyhedron, meshes_));
  }
  buckets_.resize(mesh_of_bucket_.size());
}

/// One link on its way into the buckets.
struct Draftsman::Stroke {
  Draftsman& draftsman;
  const Pose& in_camera;
  const Rgb& color;
  double pixels;  ///< of its radius in the picture
  bool in_view;

  void add(std::size_t bucket, const Vector3& base, const Vector3& unit,
           const Vector3& size) const {
    Bucket& into = draftsman.buckets_[bucket];
    (in_view ? into.visible : into.hidden)
        .push_back(instance_of(in_camera, color, base, unit, size));
  }
  std::size_t cylinders() const { return 1 + roundness_for(pixels); }
  std::size_t spheres() const { return cylinders() + roundness.size(); }

  void operator()(const scene::Box& box) const { add(0, {0, 0, 0}, box.size, box.size); }
  void operator()(const scene::Cylinder& cylinder) const {
    const double r = cylinder.radius, height = cylinder.height;
    add(cylinders(), {0, 0, 0}, {r, r, height}, {2 * r, 2 * r, height});
  }
  void operator()(const scene::Sphere& sphere) const {
    const Vector3 unit = Vector3::Constant(sphere.radius);
    add(spheres(), {0, 0, 0}, unit, 2 * unit);
  }
  /// Its parts have size 0: no edges are drawn where they meet.
  void operator()(const scene::Capsule& capsule) const {
    const double r = capsule.radius, middle = capsule.height - 2 * r;
    if (middle > 0) add(cylinders(), {0, 0, r}, {r, r, middle}, {0, 0, 0});
    for (const double base : {0.0, middle}) {
      add(spheres(), {0, 0, base}, Vector3::Constant(r), {0, 0, 0});
    }
  }
  void operator()(const scene::Hull& hull) const {
    add(draftsman.bucket_of_hull_.at(hull.polyhedron), {0, 0, 0}, {1, 1, 1},
        scene::bounds(hull).size());
  }
};

void Draftsman::draw(const world::State& state, const View& view, Drawing& drawing) {
  drawing.bodies.clear();
  drawing.batches.clear();
  drawing.marks.clear();
  drawing.lines.clear();
  drawing.labels.clear();
  drawing.floor = state.floor;
  const math::Quaternion camera_from_world = view.camera.orientation.conjugate();
  drawing.right = to_floats(camera_from_world * Vector3::UnitX());
  drawing.ahead = to_floats(camera_from_world * Vector3::UnitY());
  drawing.up = to_floats(camera_from_world * Vector3::UnitZ());
  add_bodies(state, view, drawing);
  add_marks(state, view, drawing);
  if (view.layers.rays) add_rays(state, view, drawing);
  if (view.layers.frusta) add_frusta(state, view, drawing);
  if (view.layers.labels) add_labels(state, view, drawing);
}

void Draftsman::add_bodies(const world::State& state, const View& view, Drawing& drawing) {
  for (Bucket& bucket : buckets_) {
    bucket.visible.clear();
    bucket.hidden.clear();
  }
  Bounds visible, all;
  const Pose camera_from_world = math::inverse(view.camera);
  const math::Quaternion to_light = light_from_world();
  const std::size_t links = std::min(model_.bodies.size(), layout_.links.size());
  for (std::size_t i = 0; i < links; ++i) {
    if (state.is_absent(layout_.links[i].entity)) continue;
    const Body& body = model_.bodies[i];
    const Pose in_camera = camera_from_world * state.links[i].pose;
    const Ball own = std::visit([](const auto& shape) { return ball_of(shape); }, body.geometry);
    const Ball ball{in_camera * own.center, own.radius};
    const Ball lit{to_light * (state.links[i].pose * own.center), own.radius};
    const double distance = std::max(ball.center.norm() - ball.radius, 0.01 * ball.radius);
    const double pixels = ball.radius * view.focal_length.maxCoeff() / distance;
    const bool in_view = shows(ball, view);
    std::visit(Stroke{*this, in_camera, body.color, pixels, in_view}, body.geometry);
    if (in_view) visible.add(lit);
    all.add(lit);
  }
  aim_light(visible, all, view, drawing);
  for (std::size_t i = 0; i < buckets_.size(); ++i) {
    const Bucket& bucket = buckets_[i];
    const std::size_t count = bucket.visible.size() + bucket.hidden.size();
    if (count == 0) continue;
    drawing.batches.push_back(
        {mesh_of_bucket_[i], drawing.bodies.size(), bucket.visible.size(), count});
    for (const auto* part : {&bucket.visible, &bucket.hidden}) {
      drawing.bodies.insert(drawing.bodies.end(), part->begin(), part->end());
    }
  }
}

void Draftsman::add_marks(const world::State& state, const View& view, Drawing& drawing) const {
  const Pose camera_from_world = math::inverse(view.camera);
  const auto in_view = [&](const Vector3& center, double radius) {
    return center.z() > 0 && shows({center, radius}, view);
  };
  for (std::size_t i = 0; i < layout_.tags.size(); ++i) {
    const world::TagLayout& tag = layout_.tags[i];
    if (state.is_absent(tag.mount.entity)) continue;
    const Pose pose = camera_from_world * world::pose_of(state, tag.mount);
    if (!shows({pose.position, modules_per_side * tag.side_length}, view)) continue;
    drawing.marks.push_back(tag_mark(pose, tag.side_length, state.tag_payloads[i]));
  }
  for (std::size_t i = 0; i < layout_.directional_leds.size(); ++i) {
    const world::Mount& mount = layout_.directional_leds[i].mount;
    if (state.is_absent(mount.entity)) continue;
    const Pose pose = camera_from_world * world::pose_of(state, mount);
    const double radius = led_radius_at(pose.position.z(), view);
    if (!in_view(pose.position, radius)) continue;
    drawing.marks.push_back(disc(pose.position, pose.orientation * Vector3(radius, 0, 0),
                                 pose.orientation * Vector3(0, radius, 0),
                                 state.directional_led_colors[i]));
  }
  // An LED shines all around: its disc faces the camera, in front of it by the LED's own radius.
  for (std::size_t i = 0; i < layout_.leds.size(); ++i) {
    const world::Mount& mount = layout_.leds[i].mount;
    if (state.is_absent(mount.entity)) continue;
    const Vector3 at = camera_from_world * world::position_of(state, mount);
    const double distance = at.norm();
    if (!(distance > 2 * led_radius)) continue;
    const Vector3 center = at * (1 - led_radius / distance);
    const double radius = led_radius_at(center.z(), view);
    if (!in_view(center, radius)) continue;
    drawing.marks.push_back(
        disc(center, Vector3(radius, 0, 0), Vector3(0, -radius, 0), state.led_colors[i]));
  }
}

}  // namespace ziggurat::render
