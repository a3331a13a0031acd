// SPDX-License-Identifier: MIT
// <devices> of a prototype, and <leds> of a box or cylinder.

#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>

#include "scene/draft.h"

namespace ziggurat::scene {
namespace {

constexpr unsigned most_ring_sensors = 1000;
constexpr std::size_t most_proximity_sensors = 10'000;  // of a robot

/// The id of a device: as written, or `<stem>_<N>`.
std::string read_device_id(Element& device, std::string_view stem, Ids& ids) {
  if (!device.has("id")) return ids.next(stem, device.where());
  std::string id = device.optional("id", identifier, "");
  take_id(device, ids, id, stem);
  return id;
}

/// Reads the children of a container, all of one name.
template <class Device, class Read>
std::vector<Device> read_container(Element& container, std::string_view name, Read read) {
  std::vector<Device> devices;
  Ids ids;
  for (Element& element : container.children()) {
    if (element.name() != name) {
      element.unknown_in(container.name(), std::array{name});
      continue;
    }
    Device device = read(element, read_device_id(element, name, ids));
    device.where = element.where();
    devices.push_back(std::move(device));
    element.done();
  }
  container.done();
  return devices;
}

void read_directional_leds(Draft& draft, Element& container, Entity& entity) {
  Devices& devices = entity.devices;
  devices.directional_led_medium = read_medium(draft, container, MediumKind::directional_led);
  devices.directional_leds = read_container<DirectionalLed>(
      container, "directional_led", [&draft](Element& element, std::string id) {
        const Anchor anchor = read_anchor(draft, element);
        const math::Pose pose{element.required("position", position),
                              element.required("orientation", orientation)};
        const double angle_seen = element.required("observable_angle", half_angle);
        return DirectionalLed{
            std::move(id), anchor, pose, angle_seen, element.optional("color", color, Color{}), {}};
      });
}

void read_tags(Draft& draft, Element& container, Entity& entity) {
  entity.devices.tag_medium = read_medium(draft, container, MediumKind::tag);
  entity.devices
      .tags = read_container<Tag>(container, "tag", [&draft](Element& element, std::string id) {
    const Anchor anchor = read_anchor(draft, element);
    const math::Pose pose{element.required("position", position),
                          element.required("orientation", orientation)};
    const double angle_seen = element.required("observable_angle", half_angle);
    const double side = element.required("side_length", length, 1.0);
    return Tag{
        std::move(id), anchor, pose, angle_seen, side, element.optional("payload", text, ""), {}};
  });
}

/// The medium of the radios of an entity: that of their container, or as other versions have it of
/// each radio.
void read_radios(Draft& draft, Element& container, Entity& entity) {
  auto& medium = entity.devices.radio_medium;
  const std::vector<Element> written = container.children();
  const bool each =
      !container.has("medium") &&
      std::ranges::any_of(written, [](const Element& radio) { return radio.has("medium"); });
  if (!each) medium = read_medium(draft, container, MediumKind::radio);
  entity.devices
      .radios = read_container<Radio>(container, "radio", [&](Element& element, std::string id) {
    if (each) {
      const auto own = read_medium(draft, element, MediumKind::radio);
      if (medium && own && own != medium) {
        element.fault_at("medium",
                         "is another than that of the radios before; those of an entity share one");
      }
      if (own) medium = own;
    }
    const Anchor anchor = read_anchor(draft, element);
    element.without_effect("orientation", orientation, "radios reach equally far all around");
    element.without_effect("duplex_mode", text,
                           "a radio that sends in a tick receives nothing in it");
    const math::Vector3 at = element.required("position", position);
    return Radio{std::move(id), anchor, at, element.required("range", In{"m", positive}, 1.0), {}};
  });
}

/// The volume of a magnet; nothing if it is a dipole.
std::optional<MagnetShape> read_magnet_shape(Element& element) {
  using Kind = MagnetShape::Kind;
  const auto kind = element.optional(
      "shape",
      OneOf<Kind>{{"box", Kind::box}, {"cylinder", Kind::cylinder}, {"sphere", Kind::sphere}});
  if (!element.has("shape")) return std::nullopt;
  MagnetShape shape;
  shape.kind = kind.value_or(Kind::sphere);
  if (shape.kind == Kind::box) shape.size = element.required("size", size);
  if (shape.kind != Kind::box) shape.radius = element.required("radius", length, 1.0);
  if (shape.kind == Kind::cylinder) shape.height = element.required("height", length, 1.0);
  shape.orientation = element.optional("orientation", orientation, math::Quaternion::Identity());
  return shape;
}

/// The strength of a magnet is written in the dialect's unit or in SI, not in both.
Magnet read_magnet(Draft& draft, Element& element, std::string id) {
  Magnet magnet;
  magnet.id = std::move(id);
  magnet.anchor = read_anchor(draft, element);
  magnet.offset = element.required("offset", position);
  magnet.shape = read_magnet_shape(element);
  constexpr std::array<std::string_view, 3> strengths{"passive_field", "moment", "remanence"};
  const auto passive_field = element.optional("passive_field", In{"the dialect's", vector3});
  const auto moment = element.optional("moment", In{"A·m²", vector3});
  const auto remanence = element.optional("remanence", In{"T", vector3});
  const auto given = std::ranges::count_if(
      strengths, [&](std::string_view name) { return element.has(name.data()); });
  if (given == 0) missing_all(element, strengths);
  if (given > 1) {
    element.fault("gives its strength twice; keep one of passive_field, moment and remanence");
  }
  if (element.has("remanence") && !magnet.shape) {
    element.fault_at(
        "remanence",
        "needs a volume; write shape=\"box\", \"cylinder\" or \"sphere\" with its lengths",
        {"shape"});
  }
  magnet.passive_field = passive_field.value_or(math::Vector3::Zero());
  magnet.moment = moment.value_or(math::Vector3::Zero());
  magnet.remanence = remanence.value_or(math::Vector3::Zero());
  magnet.active_field =
      element.optional("active_field", In{"the dialect's", vector3}, math::Vector3::Zero());
  return magnet;
}

void read_magnets(Draft& draft, Element& container, Entity& entity) {
  entity.devices.magnets =
      read_container<Magnet>(container, "magnet", [&draft](Element& element, std::string id) {
        return read_magnet(draft, element, std::move(id));
      });
}

/// Perception of a sensor; an element that leaves it open takes it from the next outer one.
struct Perception {
  std::optional<bool> sees_floor;
  std::optional<Response> response;
};

Perception read_perception(Element& element, const Perception& usual) {
  Perception perception = usual;
  if (const auto floor = element.optional("floor", boolean)) perception.sees_floor = floor;
  if (auto table = element.optional("response", response)) perception.response = std::move(table);
  return perception;
}

bool may_add(std::size_t sensors, const Element& element, const Entity& entity) {
  if (entity.devices.proximity_sensors.size() + sensors <= most_proximity_sensors) return true;
  element.fault(fmt::format("is one too many; a robot has at most {} proximity sensors",
                            most_proximity_sensors));
  return false;
}

void read_proximity_sensor(Draft& draft, Element& element, const Perception& usual,
                           Entity& entity) {
  const Anchor anchor = read_anchor(draft, element);
  const math::Vector3 offset = element.required("offset", position);
  const math::Vector3 along = element.required("direction", direction, math::Vector3::UnitX());
  const double reach = element.required("range", length, 1.0);
  const Perception perception = read_perception(element, usual);
  element.done();
  if (!may_add(1, element, entity)) return;
  entity.devices.proximity_sensors.push_back(
      {anchor, offset, along, reach, perception.sees_floor, perception.response, element.where()});
}

struct RingDefaults {
  std::optional<math::Vector3> center;
  std::optional<double> radius, range, start_angle;
  std::optional<unsigned> num_sensors;
};

/// Attributes of <proximity_sensors> for rings without them, as beta50 reads it.
RingDefaults read_ring_defaults(Element& container) {
  return {container.optional("center", position), container.optional("radius", length),
          container.optional("range", length), container.optional("start_angle", angle),
          container.optional("num_sensors", positive_count)};
}

template <class Read, class T>
T required_or(Element& element, const char* name, Read read, const std::optional<T>& usual,
              T fallback) {
  if (usual && !element.has(name)) {
    element.optional(name, read);
    return *usual;
  }
  return element.required(name, read, fallback);
}

void read_ring(Draft& draft, Element& ring, const RingDefaults& usual,
               const Perception& usual_perception, Entity& entity) {
  const Anchor anchor = read_anchor(draft, ring);
  const math::Vector3 center =
      ring.optional("center", position, usual.center.value_or(math::Vector3::Zero()));
  const double start = ring.optional("start_angle", angle, usual.start_angle.value_or(0.0));
  const double radius = required_or(ring, "radius", length, usual.radius, 1.0);
  const double reach = required_or(ring, "range", length, usual.range, 1.0);
  const unsigned number_of_sensors =
      required_or(ring, "num_sensors", positive_count, usual.num_sensors, 1u);
  const Perception perception = read_perception(ring, usual_perception);
  ring.done();
  if (number_of_sensors > most_ring_sensors) {
    ring.fault_at("num_sensors", fmt::format("is too many; write at most {}", most_ring_sensors));
    return;
  }
  if (!may_add(number_of_sensors, ring, entity)) return;
  for (unsigned i = 0; i < number_of_sensors; ++i) {
    const double turn = start + 2.0 * std::numbers::pi * i / number_of_sensors;
    const math::Vector3 outward(std::cos(turn), std::sin(turn), 0.0);
    entity.devices.proximity_sensors.push_back({anchor, center + radius * outward, outward, reach,
                                                perception.sees_floor, perception.response,
                                                ring.where()});
  }
}

void read_proximity_sensors(Draft& draft, Element& container, Entity& entity) {
  constexpr std::array<std::string_view, 2> known{"sensor", "ring"};
  const RingDefaults usual = read_ring_defaults(container);
  const Perception perception = read_perception(container, {});
  std::vector<Element> children = container.children();
  if (children.empty()) container.fault("has no sensor; write <sensor …> or <ring …> in it");
  for (Element& child : children) {
    if (child.name() == "sensor") {
      read_proximity_sensor(draft, child, perception, entity);
    } else if (child.name() == "ring") {
      read_ring(draft, child, usual, perception, entity);
    } else {
      child.unknown_in(container.name(), known);
    }
  }
  container.done();
}

void read_range_and_bearing(Draft& draft, Element& element, Entity& entity) {
  entity.devices.range_and_bearing_medium =
      read_medium(draft, element, MediumKind::range_and_bearing);
  const Anchor anchor = read_anchor(draft, element);
  const math::Pose pose = read_pose(element);
  const double reach = element.optional("range", In{"m", positive}, 3.0);
  const unsigned bytes = element.optional("data_size", Whole{0, most_data_bytes}, 10u);
  element.done();
  entity.devices.range_and_bearing = RangeAndBearing{anchor, pose, reach, bytes, element.where()};
}

void read_battery_container(Draft&, Element& element, Entity& entity) {
  entity.devices.battery = read_battery(element);
}

struct Container {
  std::string_view name;
  void (*read)(Draft&, Element&, Entity&);
};

constexpr std::array<Container, 8> containers{{
    {"leds", read_leds},
    {"directional_leds", read_directional_leds},
    {"tags", read_tags},
    {"radios", read_radios},
    {"magnets", read_magnets},
    {"proximity_sensors", read_proximity_sensors},
    {"range_and_bearing", read_range_and_bearing},
    {"battery", read_battery_container},
}};

void read_device_container(Draft& draft, Element& element, Entity& entity) {
  for (const Container& container : containers) {
    if (container.name == element.name()) return container.read(draft, element, entity);
  }
  std::array<std::string_view, containers.size()> known;
  for (std::size_t i = 0; i < known.size(); ++i) known[i] = containers[i].name;
  element.unknown_in("devices", known);
}

}  // namespace

Anchor read_anchor(Draft& draft, Element& element) {
  const std::string id = element.required("anchor", identifier);
  if (id.empty() || id == "origin") return {};
  const auto found = draft.anchors.find(id);
  if (found != draft.anchors.end()) return {static_cast<int>(found->second)};
  element.fault_at("anchor", "names no anchor; " + draft.report.advice(id, anchor_names(draft)),
                   {"links", "link", "id", duplicate});
  return {};
}

std::vector<std::string> anchor_names(const Draft& draft) {
  // Links with the same id have one anchor, that of the first: their numbers may have gaps.
  std::map<std::size_t, std::string> by_link;
  for (const auto& [id, link] : draft.anchors) {
    if (link <= most_compared) by_link.emplace(link, id);
  }
  std::vector<std::string> names{"origin"};
  for (auto& [link, id] : by_link) names.push_back(std::move(id));
  return names;
}

void read_leds(Draft& draft, Element& container, Entity& entity) {
  entity.devices.led_medium = read_medium(draft, container, MediumKind::led);
  entity.devices.leds =
      read_container<Led>(container, "led", [&draft](Element& element, std::string id) {
        const Anchor anchor = read_anchor(draft, element);
        const math::Vector3 offset = element.required("offset", position);
        return Led{std::move(id), anchor, offset, element.required("color", color), {}};
      });
}

Battery read_battery(Element& element) {
  enum class Discharge { time, motion, time_motion };
  const Discharge discharge =
      element.optional("discharge_model",
                       OneOf<Discharge>{{"time", Discharge::time},
                                        {"motion", Discharge::motion},
                                        {"time_motion", Discharge::time_motion}},
                       Discharge::time);
  Battery battery;
  battery.where = element.where();
  battery.full_charge = element.optional("full_charge", positive, 1.0);
  battery.start_charge = element.optional("start_charge", non_negative, battery.full_charge);
  const double factor = element.optional("factor", non_negative, 1e-5);
  const double time = element.optional("time_factor", non_negative, factor);
  const double metre = element.optional("pos_factor", non_negative, 1e-3);
  const double radian = element.optional("orient_factor", non_negative, 1e-3);
  if (battery.start_charge > battery.full_charge) {
    element.fault_at("start_charge", "is more than full_charge; write at most that");
  }
  if (discharge != Discharge::motion) battery.per_tick = time;
  if (discharge != Discharge::time) {
    battery.per_metre = metre;
    battery.per_radian = radian;
  }
  element.done();
  return battery;
}

void read_devices(Draft& draft, Element& element, Entity& entity) {
  auto devices = element.child("devices");
  if (!devices) return;
  Ids seen;
  for (Element& container : devices->children()) {
    const std::string kind(container.name());
    if (!seen.add(kind, container.where())) {
      container.fault(
          fmt::format("is the second of its kind, after the one{}; write all devices of a "
                      "kind into one element",
                      draft.report.place(seen.owner(kind), container.where())));
      continue;
    }
    read_device_container(draft, container, entity);
  }
  devices->done();
}

std::optional<unsigned> tag_pattern(std::string_view payload) {
  constexpr unsigned ids = 587;
  unsigned id = ids;
  const auto [end, error] = std::from_chars(payload.data(), payload.data() + payload.size(), id);
  if (error != std::errc() || end != payload.data() + payload.size() || id >= ids) {
    return std::nullopt;
  }
  return id;
}

}  // namespace ziggurat::scene
