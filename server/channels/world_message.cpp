// SPDX-License-Identifier: MIT
#include "channels/world_message.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <variant>
#include <vector>

#include "images/image.h"
#include "outputs/images.h"
#include "render/model.h"
#include "wire/devices.h"

namespace ziggurat::channels {
namespace {

using Entity = v1::World::Entity;

Entity::Kind kind_of(scene::EntityKind kind) {
  switch (kind) {
    case scene::EntityKind::box:
      return Entity::BOX;
    case scene::EntityKind::cylinder:
      return Entity::CYLINDER;
    case scene::EntityKind::sphere:
      return Entity::SPHERE;
    case scene::EntityKind::prototype:
      return Entity::PROTOTYPE;
    case scene::EntityKind::foot_bot:
      return Entity::FOOT_BOT;
    case scene::EntityKind::e_puck:
      return Entity::E_PUCK;
    case scene::EntityKind::eye_bot:
      return Entity::EYE_BOT;
    case scene::EntityKind::spiri:
      return Entity::SPIRI;
    case scene::EntityKind::mini_quadrotor:
      return Entity::MINI_QUADROTOR;
    case scene::EntityKind::kilobot:
      return Entity::KILOBOT;
    case scene::EntityKind::pi_puck:
      return Entity::PI_PUCK;
    case scene::EntityKind::builderbot:
      return Entity::BUILDERBOT;
    case scene::EntityKind::khepera:
      return Entity::KHEPERA;
    case scene::EntityKind::light:
      break;
  }
  return Entity::LIGHT;
}

/// Linear light -> 0xRRGGBB.
std::uint32_t to_srgb(const render::Rgb& color) {
  std::uint32_t packed = 0;
  for (const float part : color) {
    packed = packed << 8 | static_cast<std::uint32_t>(
                               std::lround(255 * std::pow(std::clamp(part, 0.0f, 1.0f), 1 / 2.2f)));
  }
  return packed;
}

/// Writes the shapes of links. Hulls that links share are written once.
struct ShapeWriter {
  v1::World& world;
  v1::World::Link* to = nullptr;
  std::map<const scene::Polyhedron*, std::uint32_t> hulls = {};

  void operator()(const scene::Box& box) const {
    add(box.size, *to->mutable_box()->mutable_size());
  }
  void operator()(const scene::Cylinder& cylinder) const {
    to->mutable_cylinder()->set_radius(cylinder.radius);
    to->mutable_cylinder()->set_height(cylinder.height);
  }
  void operator()(const scene::Sphere& sphere) const {
    to->mutable_sphere()->set_radius(sphere.radius);
  }
  void operator()(const scene::Capsule& capsule) const {
    to->mutable_capsule()->set_radius(capsule.radius);
    to->mutable_capsule()->set_height(capsule.height);
  }
  void operator()(const scene::Hull& hull) {
    const auto [known, fresh] =
        hulls.emplace(hull.polyhedron.get(), static_cast<std::uint32_t>(world.hulls_size()));
    to->set_hull(known->second);
    if (!fresh) return;
    v1::World::Hull& shape = *world.add_hulls();
    for (const auto& vertex : hull.polyhedron->vertices) add(vertex, *shape.mutable_vertices());
    for (const auto& face : hull.polyhedron->faces) {
      for (std::size_t i = 2; i < face.corners.size(); ++i) {
        for (const std::size_t corner : {face.corners[0], face.corners[i - 1], face.corners[i]}) {
          shape.add_triangles(index(corner));
        }
      }
    }
  }
};

v1::World::Joint::Type type_of(scene::JointType type) {
  switch (type) {
    case scene::JointType::fixed:
      return v1::World::Joint::FIXED;
    case scene::JointType::spherical:
      return v1::World::Joint::SPHERICAL;
    case scene::JointType::prismatic:
      return v1::World::Joint::PRISMATIC;
    case scene::JointType::revolute:
      break;
  }
  return v1::World::Joint::REVOLUTE;
}

void describe_joints(const Population& from, std::size_t entity, v1::World& to) {
  const std::size_t first = from.layout.entities[entity].links.begin;
  for (const scene::Joint& joint : from.entities[entity].joints) {
    v1::World::Joint& described = *to.add_joints();
    described.set_id(v1::valid_utf8(joint.id));
    described.set_entity(index(entity));
    described.set_type(type_of(joint.type));
    described.set_parent(index(first + joint.parent));
    described.set_child(index(first + joint.child));
    add(joint.child_frame.position, *described.mutable_position());
    add(joint.axis, *described.mutable_axis());
    if (!joint.limit || !scene::has_coordinate(joint.type)) continue;
    described.set_lower(joint.limit->lower);
    described.set_upper(joint.limit->upper);
  }
}

void describe_entity(const Population& from, std::size_t place, v1::World& to) {
  const scene::Entity& entity = from.entities[place];
  const world::EntityLayout& layout = from.layout.entities[place];
  Entity& described = *to.add_entities();
  described.set_id(v1::valid_utf8(layout.id));
  described.set_kind(kind_of(entity.kind));
  described.set_movable(entity.movable);
  described.set_removed(from.state.is_absent(place));
  if (entity.model) described.set_model(v1::valid_utf8(from.scene.models[*entity.model].id));
  described.set_first_link(index(layout.links.begin));
  described.set_link_count(index(layout.links.count));
  described.set_reference_link(index(reference_link(from, place)));
  const Mounted origin = mounted(from, {place, std::nullopt, {}});
  add(origin.pose.position, *described.mutable_origin_position());
  add(origin.pose.orientation, *described.mutable_origin_orientation());
}

void describe_links(const Population& from, v1::World& to) {
  const render::Model looks = render::make_model(from.scene, from.entities);
  to.set_has_floor(looks.has_floor);
  to.set_floor_tile(looks.tile);
  ShapeWriter writer{to};
  for (std::size_t i = 0; i < from.layout.links.size(); ++i) {
    const world::LinkLayout& layout = from.layout.links[i];
    const std::size_t first = from.layout.entities[layout.entity].links.begin;
    const scene::Link& link = from.entities[layout.entity].links[i - first];
    v1::World::Link& described = *to.add_links();
    described.set_id(v1::valid_utf8(layout.id));
    described.set_entity(index(layout.entity));
    described.set_frame(frame_of(from.layout, i));
    described.set_color(to_srgb(looks.bodies[i].color));
    described.set_collides(link.collides);
    described.set_mass(link.mass);
    writer.to = &described;
    std::visit(writer, link.geometry);
  }
}

void describe_robots(const Population& from, v1::World& to) {
  const wire::Run run{.layout = from.layout,
                      .controllers = from.scene.controllers,
                      .scripts = std::vector<std::string>(from.layout.robots.size()),
                      .scene_hash = {},
                      .server_version = {}};
  for (std::size_t i = 0; i < from.layout.robots.size(); ++i) {
    const world::RobotLayout& robot = from.layout.robots[i];
    v1::World::Robot& described = *to.add_robots();
    described.set_entity(index(robot.entity));
    wire::describe(run, i, *described.mutable_description());
    to.mutable_entities(static_cast<int>(robot.entity))->set_robot(index(i));
  }
}

/// As PNG, with at most so many pixels a side: of larger ones some pixels are left out.
std::string floor_png(const images::Image& image) {
  constexpr unsigned most = 1024;
  const unsigned step = (std::max(image.width, image.height) + most - 1) / most;
  const unsigned width = (image.width + step - 1) / step, height = (image.height + step - 1) / step;
  std::vector<std::uint8_t> rgb;
  rgb.reserve(std::size_t{3} * width * height);
  for (unsigned y = 0; y < image.height; y += step) {
    for (unsigned x = 0; x < image.width; x += step) {
      const std::uint8_t* const pixel = &image.rgb[3 * (std::size_t{y} * image.width + x)];
      rgb.insert(rgb.end(), pixel, pixel + 3);
    }
  }
  return outputs::to_png(width, height, rgb, outputs::PngEncoding::fast);
}

}  // namespace

std::size_t reference_link(const Population& population, std::size_t entity) {
  return population.layout.entities[entity].links.begin +
         population.entities[entity].reference_link;
}

Mounted mounted(const Population& population, const world::Mount& mount) {
  if (mount.link) return {*mount.link, mount.pose};
  const std::size_t link = reference_link(population, mount.entity);
  const world::State& state = population.state;
  return {link, math::inverse(state.links[link].pose) * state.origins[mount.entity] * mount.pose};
}

v1::World describe(const Population& from, std::uint64_t generation) {
  v1::World to;
  const unsigned ticks_per_second = from.scene.experiment.ticks_per_second;
  to.set_generation(generation);
  to.set_scene(v1::valid_utf8(from.path));
  to.set_scene_hash(from.scene_hash);
  to.set_seed(from.seed);
  to.set_tick_ns((1'000'000'000 + ticks_per_second / 2) / ticks_per_second);
  to.set_ticks_per_second(ticks_per_second);
  to.set_last_tick(from.last_tick);
  add(from.scene.arena.size, *to.mutable_arena_size());
  add(from.scene.arena.center, *to.mutable_arena_center());
  if (const world::FloorImage* laid = world::image_on(from.state.floor)) {
    to.set_floor_picture(floor_png(laid->image));
  } else if (from.scene.floor_image) {
    to.set_floor_picture(floor_png(*from.scene.floor_image));
  }
  for (std::size_t i = 0; i < from.layout.entities.size(); ++i) {
    describe_entity(from, i, to);
    describe_joints(from, i, to);
  }
  describe_links(from, to);
  describe_robots(from, to);
  describe_devices(from, to);
  for (const scene::ModelName& model : from.scene.models) {
    v1::World::Model& described = *to.add_models();
    described.set_id(v1::valid_utf8(model.id));
    described.set_kind(kind_of(model.kind));
  }
  for (const scene::Controller& controller : from.scene.controllers) {
    to.add_controllers(v1::valid_utf8(controller.id));
  }
  return to;
}

}  // namespace ziggurat::channels
