// Devices of controllers that only robots have which come as they are: their attributes.

#include "scene/enabling.h"
#include "scene/memory.h"
#include "scene/robots/robots.h"

namespace ziggurat::scene {

void enable_leds_of_robot(const Enabling& e) {
  LedsUse& use = e.devices.leds.emplace();
  if (e.element.has("medium")) use.medium = read_medium(e.draft, e.element, MediumKind::led);
}

void enable_kilobot_communication(const Enabling& e) {
  if (e.element.has("medium")) {
    e.described->medium = read_medium(e.draft, e.element, MediumKind::kilobot_communication);
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
