// SPDX-License-Identifier: MIT
// <actuators> and <sensors>: a table of all names of the dialect, and the attributes of each.

#include <algorithm>
#include <array>
#include <numbers>
#include <span>

#include "scene/enabling.h"
#include "scene/memory.h"

namespace ziggurat::scene {
namespace {

using Enable = void (*)(const Enabling&);

struct DeviceRow {
  std::string_view name;
  std::string_view implementation;  ///< "one|other": either
  Enable enable;
  bool is_carried = true;        ///< an entity must carry it: controllers.cpp checks that
  std::string_view places = {};  ///< of a device that describes itself: DevicePlace::name
  std::string_view kind = {};    ///< likewise, if its kind has not the name of the element
};

// --- devices modelled in Devices ----------------------------------------------------------------

constexpr std::string_view own_medium = "the medium is that of the entity's own <devices>";

/// Settings of a kind that has both an actuator and a sensor; the first call enables it.
template <class Use>
Use& use_of(std::optional<Use>& use) {
  return use ? *use : use.emplace();
}

RadiosUse& read_radios_use(const Enabling& e) {
  RadiosUse& use = use_of(e.devices.radios);
  e.element.without_effect("medium", text, own_medium);
  if (e.element.optional("show_rays", boolean, false)) use.show_rays = true;
  return use;
}

void enable_radios_actuator(const Enabling& e) { read_radios_use(e).actuator = true; }
void enable_radios_sensor(const Enabling& e) { read_radios_use(e).sensor = true; }

void enable_leds(const Enabling& e) {
  e.devices.leds.emplace().medium = read_medium(e.draft, e.element, MediumKind::led);
}

void enable_directional_leds(const Enabling& e) {
  e.devices.directional_leds = true;
  e.element.without_effect("medium", text, own_medium);
}

void enable_tags(const Enabling& e) {
  e.devices.tags = true;
  e.element.without_effect("medium", text, own_medium);
}

void enable_magnets(const Enabling& e) { e.devices.magnets = true; }
void enable_markers(const Enabling& e) { e.devices.draws_markers = true; }

/// <proximity> or <footbot_proximity>: both make the same table of a robot.
ProximityUse& enable_rays(const Enabling& e, std::string_view other) {
  if (e.devices.proximity) {
    e.draft.report.notice(
        e.element.where(),
        fmt::format("<{}> replaces <{}>: both make robot.proximity", e.element.name(), other));
  }
  ProximityUse& use = e.devices.proximity.emplace();
  use.show_rays = e.element.optional("show_rays", boolean, false);
  use.noise = e.element.optional("noise_level", non_negative, 0.0);
  return use;
}

void enable_proximity(const Enabling& e) {
  ProximityUse& use = enable_rays(e, "footbot_proximity");
  use.sees_floor = e.element.optional("floor", boolean, false);
  use.response = e.element.optional("response", response);
}

void enable_cameras(const Enabling& e) {
  CamerasUse& use = e.devices.cameras.emplace();
  use.show_frustum = e.element.optional("show_frustum", boolean, false);
  use.cameras = read_cameras(e.draft, e.element, e.use);
}

/// @param in_si  factor to the SI unit
NoiseRange read_noise(Element& element, const char* name, std::string_view unit, double in_si = 1) {
  const auto [min, max] = element.optional(name, In{unit, range}, {0.0, 0.0});
  return {min * in_si, max * in_si};
}

void enable_positioning(const Enabling& e) {
  PositioningUse& use = e.devices.positioning.emplace();
  use.position = read_noise(e.element, "pos_noise_range", "m");
  use.angle = read_noise(e.element, "angle_noise_range", "°", std::numbers::pi / 180);
  use.axis = read_noise(e.element, "axis_noise_range", "");
}

void enable_battery(const Enabling& e) {
  e.devices.battery.emplace().charge = read_noise(e.element, "noise_range", "");
}

void enable_range_and_bearing_actuator(const Enabling& e) {
  use_of(e.devices.range_and_bearing).actuator = true;
}

void enable_range_and_bearing_sensor(const Enabling& e) {
  RangeAndBearingUse& use = use_of(e.devices.range_and_bearing);
  use.sensor = true;
  use.medium = read_medium(e.draft, e.element, MediumKind::range_and_bearing);
  use.noise = e.element.optional("noise_std_dev", In{"m", non_negative}, 0.0);
  use.loss = e.element.optional("packet_drop_prob", probability, 0.0);
  use.show_rays = e.element.optional("show_rays", boolean, false);
}

/// Reads the children of a sensor that are fixed to an anchor: all named `name`, each
/// with an id and an anchor, and what `read` reads.
template <class Device, class Read>
void read_mounted(const Enabling& e, std::string_view name, std::vector<Device>& devices,
                  Read read) {
  Ids ids;
  for (Element& element : e.element.children()) {
    if (element.name() != name) {
      element.unknown_in(e.element.name(), std::array{name});
      continue;
    }
    Device device;
    device.id = element.required("id", identifier);
    device.anchor = element.required("anchor", identifier);
    take_id(element, ids, device.id, name);
    e.use.anchors.push_back(
        {fmt::format("{} {}", name, in_quotes(device.id)), device.anchor, element.where("anchor")});
    read(element, device);
    element.done();
    e.devices.mounted_memory += memory_of_mounted(device.id);
    devices.push_back(std::move(device));
  }
  if (devices.empty()) {
    e.element.fault(
        fmt::format("has no sensor; write <{} id=\"…\" anchor=\"origin\"/> in it", name));
  }
}

void enable_imus(const Enabling& e) {
  read_mounted(e, "imu", e.devices.imus, [](Element& element, Imu& imu) {
    imu.pose = read_pose(element);
    imu.acceleration_noise = element.optional("acceleration_noise", In{"m/s²", non_negative}, 0.0);
    imu.acceleration_bias_walk =
        element.optional("acceleration_bias_walk", In{"m/s²/√s", non_negative}, 0.0);
    imu.angular_velocity_noise =
        element.optional("angular_velocity_noise", In{"rad/s", non_negative}, 0.0);
    imu.angular_velocity_bias_walk =
        element.optional("angular_velocity_bias_walk", In{"rad/s/√s", non_negative}, 0.0);
  });
}

void enable_contact_sensors(const Enabling& e) {
  read_mounted(e, "contact_sensor", e.devices.contact_sensors, [](Element&, ContactSensor&) {});
}

// --- devices of robots on wheels ----------------------------------------------------------------

/// Values of the left and the right wheel; a value for both is their default.
template <class Read>
std::array<double, 2> read_sides(Element& element, std::array<const char*, 3> names, Read read,
                                 double usual) {
  const double both = element.optional(names[0], read, usual);
  return {element.optional(names[1], read, both), element.optional(names[2], read, both)};
}

/// @param deviation  usual one of the factor: of a wheel's speed
void read_wheels(const Enabling& e, double deviation) {
  const auto bias_mean =
      read_sides(e.element, {"bias_avg", "bias_avg_left", "bias_avg_right"}, In{"m/s", number}, 0);
  const auto bias_deviation =
      read_sides(e.element, {"bias_stddev", "bias_stddev_left", "bias_stddev_right"},
                 In{"m/s", non_negative}, 0);
  const auto factor_mean =
      read_sides(e.element, {"factor_avg", "factor_avg_left", "factor_avg_right"}, number, 1);
  const auto factor_deviation =
      read_sides(e.element, {"factor_stddev", "factor_stddev_left", "factor_stddev_right"},
                 non_negative, deviation);
  WheelsUse& use = use_of(e.devices.wheels);
  use.actuator = true;
  for (std::size_t i = 0; i < 2; ++i) {
    use.noise[i] = {bias_mean[i], bias_deviation[i], factor_mean[i], factor_deviation[i]};
  }
}

void enable_wheels(const Enabling& e) { read_wheels(e, 0); }

/// Noise of the e-puck's own wheels is a share of their speed.
void enable_epuck_wheels(const Enabling& e) {
  read_wheels(e, e.element.optional("noise_std_dev", non_negative, 0.0));
}

void enable_wheel_encoders(const Enabling& e) {
  WheelsUse& use = use_of(e.devices.wheels);
  use.sensor = true;
  use.velocity_noise = read_noise(e.element, "vel_noise_range", "cm/s", 0.01);
  use.distance_noise = read_noise(e.element, "dist_noise_range", "cm", 0.01);
}

void enable_turret(const Enabling& e) { use_of(e.devices.turret).actuator = true; }
void enable_turret_encoder(const Enabling& e) { use_of(e.devices.turret).encoder = true; }
void enable_footbot_proximity(const Enabling& e) { enable_rays(e, "proximity").footbot = true; }

// --- devices that describe themselves -----------------------------------------------------------

void enable_rays_and_noise(const Enabling& e) {
  if (e.element.optional("show_rays", boolean, false)) e.described->show_rays = true;
  e.described->noise = e.element.optional("noise_level", non_negative, 0.0);
}

/// Sensors of the e-puck read as if they were calibrated.
void enable_epuck_sensor(const Enabling& e) {
  enable_rays_and_noise(e);
  e.element.without_effect("calibrated", boolean, "all sensors are alike");
}

/// The sensor is also the switch: scripts turn the camera on.
void enable_blob_camera(const Enabling& e) {
  e.described->actuator = true;
  e.described->medium = read_medium(e.draft, e.element, MediumKind::led);
  e.described->noise = e.element.optional("noise_std_dev", non_negative, 0.0);
  e.described->show_rays = e.element.optional("show_rays", boolean, false);
}

void enable_scanner(const Enabling& e) {
  if (e.element.optional("show_rays", boolean, false)) e.described->show_rays = true;
  e.element.without_effect("noise_range", text, "the distance scanner has no noise");
}

/// The actuator also tells whether the gripper holds something. [N]
void enable_gripper(const Enabling& e) {
  constexpr double usual = 10'000;
  e.described->sensor = true;
  e.described->strength = e.element.optional("max_force", In{"N", positive}, usual);
}

void enable_nothing(const Enabling&) {}

// --- the tables ---------------------------------------------------------------------------------

constexpr std::string_view drive = "differential_drive", finders = "rangefinders",
                           lift = "lift_system";

constexpr auto actuator_rows = std::to_array<DeviceRow>({
    {"joints", "default", enable_joint_actuators, false},
    {"radios", "default", enable_radios_actuator},
    {"leds", "default", enable_leds},
    {"directional_leds", "default", enable_directional_leds},
    {"tags", "default", enable_tags},
    {"magnets", "default", enable_magnets},
    {"debug", "default", enable_markers, false},
    {"differential_steering", "default", enable_wheels},
    {"gripper", "default", enable_gripper, true, "gripper"},
    {"range_and_bearing", "default", enable_range_and_bearing_actuator},
    {"quadrotor_position", "default", enable_nothing, true, "quadrotor", "quadrotor"},
    {"quadrotor_speed", "default", enable_nothing, true, "quadrotor", "quadrotor"},
    {"footbot_turret", "default", enable_turret},
    {"footbot_gripper", "default", enable_gripper, true, "gripper", "gripper"},
    {"footbot_distance_scanner", "default", enable_nothing, true, "footbot_distance_scanner"},
    {"kilobot_differential_drive", "default", enable_nothing, true, "kilobot_motors"},
    {"kilobot_led", "default", enable_leds_of_robot},
    {"kilobot_communication", "default", enable_nothing, true, "kilobot_communication"},
    {"pipuck_differential_drive", "default", enable_nothing, true, drive, drive},
    {"pipuck_leds", "default", enable_leds_of_robot},
    {"builderbot_differential_drive", "default", enable_nothing, true, drive, drive},
    {"builderbot_leds", "default", enable_leds_of_robot},
    {"builderbot_lift_system", "default", enable_nothing, true, lift, lift},
    {"builderbot_electromagnet_system", "default", enable_magnets},
    {"builderbot_nfc", "default", enable_radios_actuator},
    {"kheperaiv_leds", "default", enable_leds_of_robot},
    {"wifi", "default", enable_radios_actuator},
    {"epuck_wheels", "default|rot_z_only|medium", enable_epuck_wheels},
    {"epuck_leds", "default|rot_z_only|medium", enable_leds},
    {"epuck_range_and_bearing", "default|rot_z_only|medium", enable_range_and_bearing_actuator},
});

constexpr auto sensor_rows = std::to_array<DeviceRow>({
    {"joints", "default", enable_joint_sensors, false},
    {"radios", "default", enable_radios_sensor},
    {"cameras", "default", enable_cameras, false},
    {"imus", "default", enable_imus, false},
    {"contact_sensors", "default", enable_contact_sensors, false},
    {"proximity", "default", enable_proximity},
    {"positioning", "default", enable_positioning, false},
    {"differential_steering", "default", enable_wheel_encoders},
    {"battery", "default", enable_battery},
    {"ground", "rot_z_only", enable_rays_and_noise, true, "ground"},
    {"light", "default", enable_rays_and_noise, true, "light"},
    {"range_and_bearing", "medium", enable_range_and_bearing_sensor},
    {"colored_blob_omnidirectional_camera", "rot_z_only", enable_blob_camera, true,
     "colored_blob_omnidirectional_camera"},
    {"colored_blob_perspective_camera", "default", enable_blob_camera, true,
     "colored_blob_perspective_camera"},
    {"footbot_proximity", "default", enable_footbot_proximity},
    {"eyebot_proximity", "default", enable_footbot_proximity},
    {"footbot_light", "rot_z_only", enable_rays_and_noise, true, "light"},
    {"eyebot_light", "rot_z_only", enable_rays_and_noise, true, "light"},
    {"footbot_base_ground", "rot_z_only", enable_rays_and_noise, true, "base_ground"},
    {"footbot_motor_ground", "rot_z_only", enable_rays_and_noise, true, "motor_ground"},
    {"footbot_turret_encoder", "default", enable_turret_encoder},
    {"kilobot_light", "rot_z_only|default", enable_rays_and_noise, true, "light", "light"},
    {"kilobot_communication", "default", enable_kilobot_communication, true,
     "kilobot_communication"},
    {"pipuck_differential_drive", "default", enable_nothing, true, drive, drive},
    {"pipuck_rangefinders", "default|rot_z_only", enable_rays_and_noise, true, finders, finders},
    {"pipuck_ground", "default|rot_z_only", enable_rays_and_noise, true, "ground", "ground"},
    {"pipuck_imu", "default", enable_imu_of_robot, false},
    {"builderbot_differential_drive", "default", enable_nothing, true, drive, drive},
    {"builderbot_rangefinders", "default", enable_rays_and_noise, true, finders, finders},
    {"builderbot_lift_system", "default", enable_nothing, true, lift, lift},
    {"builderbot_electromagnet_system", "default", enable_magnets},
    {"builderbot_camera_system", "default", enable_builderbot_camera},
    {"builderbot_nfc", "default", enable_radios_sensor},
    {"kheperaiv_proximity", "default|rot_z_only", enable_footbot_proximity},
    {"kheperaiv_light", "default|rot_z_only", enable_rays_and_noise, true, "light",
     "footbot_light"},
    {"kheperaiv_ground", "default|rot_z_only", enable_rays_and_noise, true, "ground",
     "epuck_ground"},
    {"kheperaiv_ultrasound", "default|rot_z_only", enable_rays_and_noise, true, "ultrasound"},
    {"footbot_distance_scanner", "rot_z_only", enable_scanner, true, "footbot_distance_scanner"},
    {"wifi", "default", enable_radios_sensor},
    {"epuck_wheels", "default|rot_z_only|medium", enable_wheel_encoders},
    {"epuck_proximity", "default|rot_z_only|medium", enable_epuck_sensor, true, "infrared"},
    {"epuck_light", "default|rot_z_only|medium", enable_epuck_sensor, true, "infrared"},
    {"epuck_ground", "default|rot_z_only|medium", enable_epuck_sensor, true, "ground"},
    {"epuck_range_and_bearing", "default|rot_z_only|medium", enable_range_and_bearing_sensor},
});

/// Words for `implementation`: "one|other".
Words implementations(const DeviceRow& row) {
  std::vector<std::string_view> words;
  for (std::string_view left = row.implementation; !left.empty();) {
    words.push_back(left.substr(0, left.find('|')));
    left.remove_prefix(std::min(left.size(), words.back().size() + 1));
  }
  return Words(std::move(words));
}

void read_device(const Enabling& e, const DeviceRow& row) {
  e.element.required("implementation", implementations(row));
  if (row.is_carried) {
    e.use.devices.push_back({std::string(row.name), e.element.where(), row.places});
  }
  row.enable(e);
  e.element.done();
}

std::vector<std::string_view> names_of(std::span<const DeviceRow> rows) {
  std::vector<std::string_view> names;
  for (const DeviceRow& row : rows) names.push_back(row.name);
  return names;
}

/// The use of a device that describes itself: all elements of its kind share one.
DescribedUse* described_use(const DeviceRow& row, ControllerDevices& devices, bool is_sensor) {
  if (row.places.empty()) return nullptr;
  const std::string_view kind = row.kind.empty() ? row.name : row.kind;
  auto use = std::ranges::find(devices.described, kind, &DescribedUse::kind);
  if (use == devices.described.end()) {
    use = devices.described.insert(devices.described.end(), DescribedUse());
    use->kind = kind;
    use->places = row.places;
  }
  (is_sensor ? use->sensor : use->actuator) = true;
  return &*use;
}

/// @param others  rows of the other list
void read_device_list(Draft& draft, Element& list, ControllerDevices& devices, ControllerUse& use,
                      std::span<const DeviceRow> rows, std::span<const DeviceRow> others) {
  for (Element& element : last_of_each_name(list)) {
    Enabling enabling{draft, element, devices, use};
    bool known = false;
    for (const DeviceRow& row : rows) {
      if (row.name != element.name()) continue;
      known = true;
      enabling.described = described_use(row, devices, list.name() == "sensors");
      read_device(enabling, row);
    }
    if (known) continue;
    const bool is_of_others =
        std::ranges::find(others, element.name(), &DeviceRow::name) != others.end();
    const std::string_view home = list.name() == "sensors" ? "actuators" : "sensors";
    element.unknown_in(list.name(), names_of(rows), is_of_others ? home : std::string_view());
  }
  list.done();
}

}  // namespace

std::vector<Element> last_of_each_name(Element& list) {
  std::vector<Element> result;
  std::unordered_map<std::string_view, std::size_t> positions;
  for (Element& element : list.children()) {
    const auto [position, fresh] = positions.emplace(element.name(), result.size());
    if (fresh) {
      result.push_back(element);
      continue;
    }
    list.report().notice(result[position->second].where(),
                         fmt::format("this <{}> has no effect: a later one in the same <{}> "
                                     "replaces it",
                                     element.name(), list.name()));
    result[position->second] = element;
  }
  return result;
}

std::vector<std::string_view> actuator_names() { return names_of(actuator_rows); }
std::vector<std::string_view> sensor_names() { return names_of(sensor_rows); }

void read_actuators(Draft& draft, Element& list, ControllerDevices& devices, ControllerUse& use) {
  read_device_list(draft, list, devices, use, actuator_rows, sensor_rows);
}

void read_sensors(Draft& draft, Element& list, ControllerDevices& devices, ControllerUse& use) {
  read_device_list(draft, list, devices, use, sensor_rows, actuator_rows);
}

}  // namespace ziggurat::scene
