// SPDX-License-Identifier: MIT
// Devices of controllers that only robots have which come as they are: their attributes.

#include "scene/enabling.h"
#include "scene/memory.h"
#include "scene/robots/robots.h"

namespace ziggurat::scene {
namespace {

/// The medium that the element names, if it names one.
std::optional<std::size_t> read_own_medium(const Enabling& e, MediumKind kind) {
  e.element.tell("medium", &identifier, Need::optional);
  return e.element.has("medium") ? read_medium(e.draft, e.element, kind) : std::nullopt;
}

}  // namespace

void enable_leds_of_robot(const Enabling& e) {
  e.devices.leds.emplace().medium = read_own_medium(e, MediumKind::led);
}

void enable_kilobot_communication(const Enabling& e) {
  if (const auto own = read_own_medium(e, MediumKind::kilobot_communication)) {
    e.described->medium = own;
  }
  e.described->noise = e.element.optional("noise_std_dev", In{"m", non_negative}, 0.0);
  e.described->loss = e.element.optional("message_drop_prob", probability, 0.0);
  e.element.without_effect("show_rays", boolean, "messages are not drawn");
}

void enable_imu_of_robot(const Enabling& e) {
  Imu imu;
  imu.id = "imu";
  imu.anchor = "origin";
  e.devices.mounted_memory += memory_of_mounted(imu.id);
  e.devices.imus.push_back(std::move(imu));
}

void enable_builderbot_camera(const Enabling& e) {
  CamerasUse& use = e.devices.cameras.emplace();
  use.show_frustum = e.element.optional("show_frustum", boolean, false);
  const bool rays = e.element.optional("show_tag_rays", boolean, false);
  Camera camera = builderbot::camera();
  camera.where = e.element.where();
  const auto tags = first_medium(e.draft.scene, MediumKind::tag);
  const auto leds = first_medium(e.draft.scene, MediumKind::directional_led);
  if (tags) camera.detectors.push_back({Detector::Kind::tag, *tags, rays, camera.where});
  if (leds)
    camera.detectors.push_back({Detector::Kind::directional_led, *leds, rays, camera.where});
  use.cameras.push_back(std::move(camera));
}

}  // namespace ziggurat::scene
