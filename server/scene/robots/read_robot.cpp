// <foot-bot> and <e-puck>: what a scene may say of a robot that comes as it is.

#include "scene/draft.h"
#include "scene/robots/robots.h"

namespace ziggurat::scene {
namespace {

void read_steering_limits(Element engine, Traction& traction) {
  if (auto steering = engine.child("differential_steering")) {
    traction.max_force = steering->optional("max_force", positive, traction.max_force);
    traction.max_torque = steering->optional("max_torque", positive, traction.max_torque);
    steering->done();
  }
  engine.done();
}

/// The first medium of a kind: where devices are that the scene does not give one.
std::optional<std::size_t> first_medium(const Scene& scene, MediumKind kind) {
  for (std::size_t i = 0; i < scene.media.size(); ++i) {
    if (scene.media[i].kind == kind) return i;
  }
  return std::nullopt;
}

/// Attributes of the coloured-blob cameras, which are still to come.
void check_blob_cameras(Element& element, EntityKind kind) {
  if (kind == EntityKind::foot_bot) {
    element.optional("omnidirectional_camera_aperture", half_angle);
    element.optional("perspective_camera_front", boolean);
  }
  element.optional("perspective_camera_aperture", half_angle);
  element.optional("perspective_camera_focal_length", positive);
  element.optional("perspective_camera_range", positive);
}

}  // namespace

void read_robot(Draft& draft, Element& element, Entity& entity) {
  entity.kind == EntityKind::foot_bot ? foot_bot::equip(entity) : e_puck::equip(entity);
  entity.movable = element.optional("movable", boolean, true);
  for (std::size_t i = 0; i < entity.links.size(); ++i) {
    entity.links[i].where = element.where();
    draft.anchors.emplace(entity.links[i].id, i);
  }
  Devices& devices = entity.devices;
  RangeAndBearing& antenna = *devices.range_and_bearing;
  antenna.range = element.optional("rab_range", positive, antenna.range);
  antenna.data_size =
      element.optional("rab_data_size", Whole{0, most_data_bytes}, antenna.data_size);
  devices.range_and_bearing_medium = first_medium(draft.scene, MediumKind::range_and_bearing);
  devices.led_medium = first_medium(draft.scene, MediumKind::led);
  check_blob_cameras(element, entity.kind);
  if (auto battery = element.child("battery")) devices.battery = read_battery(*battery);
  if (auto engine = element.child("dynamics2d")) read_steering_limits(*engine, *entity.traction);
}

}  // namespace ziggurat::scene
