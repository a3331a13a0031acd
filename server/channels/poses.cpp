// SPDX-License-Identifier: MIT
#include "channels/poses.h"

#include "channels/world_message.h"
#include "magnetism/dipole.h"
#include "magnetism/shape.h"
#include "scene/joint_coordinates.h"

namespace ziggurat::channels {
namespace {

double volume_of(const scene::MagnetShape& shape) {
  switch (shape.kind) {
    case scene::MagnetShape::Kind::box:
      return magnetism::volume(magnetism::Box{shape.size});
    case scene::MagnetShape::Kind::cylinder:
      return magnetism::volume(magnetism::Cylinder{shape.radius, shape.height});
    case scene::MagnetShape::Kind::sphere:
      break;
  }
  return magnetism::volume(magnetism::Sphere{shape.radius});
}

PoseSource::Magnet source_of(const Population& from, const scene::Magnet& magnet,
                             const world::Mount& mount) {
  math::Vector3 own = magnet.moment;
  if (magnet.shape) {
    own += magnetism::moment_of_remanence(magnet.remanence, volume_of(*magnet.shape));
  }
  const math::Quaternion turn = mounted(from, {mount.entity, mount.link, {}}).pose.orientation;
  return {turn, turn * own};
}

}  // namespace

PoseSource pose_source(const Population& from) {
  PoseSource source;
  for (std::size_t i = 0; i < from.entities.size(); ++i) {
    const std::size_t first = from.layout.entities[i].links.begin;
    for (const scene::Joint& joint : from.entities[i].joints) {
      source.joints.push_back({&joint, first + joint.parent, first + joint.child});
    }
    for (const scene::Magnet& magnet : from.entities[i].devices.magnets) {
      const world::Mount& mount = from.layout.magnets[source.magnets.size()].mount;
      source.magnets.push_back(source_of(from, magnet, mount));
    }
  }
  const auto magnetism = from.scene.physics.magnetism.value_or(scene::Magnetism{});
  source.dialect =
      magnetism::moment_of_dialect_field(math::Vector3::UnitX(), magnetism.force_constant).x();
  source.tag_payloads = from.state.tag_payloads;
  return source;
}

void fill(const PoseSource& source, const Moment& from, v1::Poses& to) {
  to.Clear();
  to.set_tick(from.state.tick);
  to.set_time_ns(from.state.time_ns);
  to.mutable_positions()->Reserve(static_cast<int>(3 * from.state.links.size()));
  to.mutable_orientations()->Reserve(static_cast<int>(4 * from.state.links.size()));
  for (const world::LinkState& link : from.state.links) {
    add(link.pose.position, *to.mutable_positions());
    add(link.pose.orientation, *to.mutable_orientations());
  }
  for (const PoseSource::Joint& joint : source.joints) {
    to.add_joint_positions(static_cast<float>(position_of(
        *joint.joint, from.state.links[joint.parent].pose, from.state.links[joint.child].pose)));
  }
  for (const world::Color color : from.state.led_colors) to.add_led_colors(color);
  for (const world::Color color : from.state.directional_led_colors) {
    to.add_directional_led_colors(color);
  }
  for (std::size_t i = 0; i < source.tag_payloads.size(); ++i) {
    if (from.state.tag_payloads[i] == source.tag_payloads[i]) continue;
    v1::Poses::TagPayload& changed = *to.add_tag_payloads();
    changed.set_tag(index(i));
    changed.set_payload(from.state.tag_payloads[i]);
  }
  for (std::size_t i = 0; i < source.magnets.size(); ++i) {
    const PoseSource::Magnet& magnet = source.magnets[i];
    to.add_magnet_currents(static_cast<float>(from.commands.magnet_currents[i]));
    const math::Vector3 field = magnet.turn * from.state.magnet_fields[i];
    add(math::Vector3(magnet.own + source.dialect * field), *to.mutable_magnet_moments());
  }
  for (const world::FloorPaint& region : from.state.floor) {
    if (region.image) continue;  // World has it
    for (const double value : region.center) to.add_floor_paints(value);
    for (const double value : region.half_size) to.add_floor_paints(value);
    to.add_floor_paints(region.is_disc ? 1 : 0);
    to.add_floor_paints(region.color);
  }
}

}  // namespace ziggurat::channels
