// SPDX-License-Identifier: MIT
#pragma once
// The robots that the dialect has by name. Each file has one robot's table of constants and
// writes them into an entity: links, wheels, devices. Settings of a scene come on top.

#include "scene/scene.h"

namespace ziggurat::scene {

/// A foot-bot: anchors `base`, `turret` and `perspective_camera`, two wheels, a turret, 13 LEDs,
/// 24 proximity sensors, range and bearing.
namespace foot_bot {
void equip(Entity& entity);

struct BlobCameras {
  double omnidirectional_aperture = 0;  ///< half-angle [rad]
  bool looks_ahead = true;              ///< the perspective camera: not upward
  double aperture = 0;  ///< of the perspective camera: half-angle of its diagonal [rad]
  double focal_length = 0, range = 0;  ///< likewise [m]
};
/// After equip().
void add_blob_cameras(Entity& entity, const BlobCameras& cameras);
/// Adds its radio. @param range  [m]
void add_wifi(Entity& entity, double range);
}  // namespace foot_bot

/// An e-puck: anchor `base`, two wheels, 10 LEDs, 8 proximity sensors, range and bearing.
namespace e_puck {
void equip(Entity& entity);
}

/// Robots that fly: a body without wheels, their ranges and their cameras.
namespace flying {
void equip_eye_bot(Entity& entity);
void equip_spiri(Entity& entity);
void equip_mini_quadrotor(Entity& entity);

struct Camera {
  double aperture = 0;                 ///< half-angle of the picture's diagonal [rad]
  double focal_length = 0, range = 0;  ///< [m]
};
/// Adds the coloured-blob camera, after equipping one that has the anchor for it.
void add_camera(Entity& entity, const Camera& camera);
}  // namespace flying

/// A kilobot: two motors, one LED, a sensor of ambient light, messages.
namespace kilobot {
void equip(Entity& entity);

struct Settings {
  double left_motor = 1, right_motor = 1;  ///< strength, relative to a usual one
  double range = 0;                        ///< of its messages [m]
};
/// After equip().
void add_devices(Entity& entity, const Settings& settings);
}  // namespace kilobot

/// A pi-puck: an e-puck with rangefinders.
namespace pi_puck {
void equip(Entity& entity);
}

/// A builderbot: a body on two wheels, a lift with an end effector, rangefinders, magnets, a radio.
namespace builderbot {
void equip(Entity& entity);
/// Its camera, without detectors.
Camera camera();
}  // namespace builderbot

/// A Khepera IV: a body on two wheels, infrared and ultrasound, ground sensors, LEDs.
namespace khepera {
void equip(Entity& entity);
}

/// A block of the construction kit: a cube with magnets, tags, radios and LEDs.
namespace block {
void equip(Entity& entity);
}

/// The first medium of a kind: where devices are that the scene does not give one.
std::optional<std::size_t> first_medium(const Scene& scene, MediumKind kind);

/// A body that is an upright cylinder on the floor: the link `base`.
Link wheeled_body(double radius, double height, double mass);

/// A frame that moves with the body: it has no collider and no mass.
/// @param offset  X_EL
Link frame(std::string id, const math::Pose& offset);

/// A sensor on the surface of the body that looks outward, level.
/// @param bearing  about +z from +x [rad];  @param height, radius, range  [m]
ProximitySensor outward_sensor(double bearing, double height, double radius, double range);

/// Adds a place on the surface of the body that looks outward, level: its x axis.
/// @param bearing  about +z from +x [rad];  @param height, radius  [m]
void add_outward_place(Entity& entity, std::string_view name, double bearing, double height,
                       double radius);

/// Adds a level place that looks ahead.
/// @param settings  DevicePlace::settings
DevicePlace& add_place(Entity& entity, std::string_view name, const math::Vector3& position,
                       std::vector<double> settings = {});

/// A ring of LEDs around the body's axis, counter-clockwise, numbered on from those it has.
/// @param first  bearing of the first one [rad];  @param radius, height  [m]
void add_led_ring(Entity& entity, unsigned count, double first, double radius, double height);

/// A range-and-bearing device on the body's axis, level.
/// @param height, range  [m];  @param data_size  [bytes]
RangeAndBearing level_range_and_bearing(double height, double range, unsigned data_size);

}  // namespace ziggurat::scene
