// <foot-bot> and <e-puck>: what a scene may say of a robot that comes as it is.

#include <numbers>

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

/// Half-angle of a camera, below 90 degrees.
double read_aperture(Element& element, const char* name, double usual) {
  const double found = element.optional(name, half_angle, usual);
  if (found < std::numbers::pi / 2 && found > 0) return found;
  element.fault_at(name, "must be more than 0 and less than 90 degrees");
  return usual;
}

void read_blob_cameras(Element& element, Entity& entity) {
  constexpr double degree = std::numbers::pi / 180;
  foot_bot::BlobCameras cameras{};
  cameras.omnidirectional_aperture =
      read_aperture(element, "omnidirectional_camera_aperture", 70 * degree);
  cameras.looks_ahead = element.optional("perspective_camera_front", boolean, true);
  cameras.aperture = read_aperture(element, "perspective_camera_aperture", 30 * degree);
  cameras.focal_length = element.optional("perspective_camera_focal_length", positive, 0.035);
  cameras.range = element.optional("perspective_camera_range", positive, 2.0);
  foot_bot::add_blob_cameras(entity, cameras);
}

/// The e-puck has no such camera.
void ignore_blob_cameras(Element& element) {
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
  devices.radio_medium = first_medium(draft.scene, MediumKind::radio);
  for (Radio& wifi : devices.radios)
    wifi.range = element.optional("wifi_range", positive, wifi.range);
  devices.led_medium = first_medium(draft.scene, MediumKind::led);
  entity.kind == EntityKind::foot_bot ? read_blob_cameras(element, entity)
                                      : ignore_blob_cameras(element);
  devices.battery = Battery{};  // which nothing discharges
  if (auto battery = element.child("battery")) devices.battery = read_battery(*battery);
  if (auto engine = element.child("dynamics2d")) read_steering_limits(*engine, *entity.traction);
}

}  // namespace ziggurat::scene
