// SPDX-License-Identifier: MIT
#include "world/archive.h"

#include <algorithm>
#include <tuple>
#include <type_traits>

namespace ziggurat::world {

namespace {

void archive_links(math::Archive& archive, std::vector<LinkState>& links) {
  for (LinkState& link : links) {
    archive("pose", link.pose);
    archive("velocity", link.velocity);
    archive("angular_velocity", link.angular_velocity);
  }
}

/// A part of a list.
template <class Number>
void archive_range(math::Archive& archive, Number& begin, Number& size, std::size_t of) {
  archive("begin", begin);
  archive("size", size);
  archive.require(begin <= of && size <= of - begin, "is beyond its list");
}

void archive_messages(math::Archive& archive, const Layout& layout, RadioMessages& messages) {
  archive.list("bytes", messages.bytes);
  archive.list("entries", messages.entries, [&](RadioMessages::Entry& entry) {
    math::archive_index(archive, "radio", entry.radio, layout.radios.size());
    math::archive_index(archive, "sender", entry.sender,
                        std::max<std::size_t>(layout.radios.size(), 1));
    archive_range(archive, entry.begin, entry.size, messages.bytes.size());
  });
}

/// Values that follow each other are those of the devices of a list.
template <Numbers T>
void archive_numbers(math::Archive& archive, std::string_view name, std::vector<T>& values) {
  for (T& value : values) {
    auto copy = numbers(value);
    archive(name, copy);
    value = std::bit_cast<T>(copy);
  }
}

/// The file of an image; no bytes: there is none.
void archive_image(math::Archive& archive, std::shared_ptr<const FloorImage>& image) {
  std::string file = image ? image->file : std::string();
  archive("image", file);
  if (!archive.reads()) return;
  image = nullptr;
  if (file.empty()) return;
  auto read = floor_image(std::move(file));
  archive.require(read.index() == 0, "is no image");
  image = std::get<0>(std::move(read));
}

void archive_floor(math::Archive& archive, std::string_view name, std::vector<FloorPaint>& floor) {
  archive.list(
      name, floor,
      [&](FloorPaint& region) {
        archive("center", region.center);
        archive("half_size", region.half_size);
        archive("is_disc", region.is_disc);
        archive("color", region.color);
        archive_image(archive, region.image);
        archive.require(is_valid(region), "is no region of a floor");
      },
      most_floor_paints);
}

void archive_markers(math::Archive& archive, const Layout& layout, std::vector<Marker>& markers) {
  archive.list("markers", markers, [&](Marker& marker) {
    math::archive_index(archive, "robot", marker.robot, layout.robots.size());
    math::archive_choice(archive, "shape", marker.shape, Marker::Shape::text);
    archive("at", marker.at);
    archive("to", marker.to);
    archive("radius", marker.radius);
    archive("color", marker.color);
    archive("text", marker.text);
    archive.require(is_valid(marker), "is no marker");
  });
}

}  // namespace

void archive(math::Archive& archive, const Layout& layout, State& state) {
  static_assert(field_count<State>() == 14);
  archive("tick", state.tick);
  archive("time_ns", state.time_ns);
  archive("origins", state.origins);
  archive_links(archive, state.links);
  archive.list("absent", state.absent);
  archive.require(state.absent.size() <= layout.entities.size(), "is too long");
  archive("led_colors", state.led_colors);
  archive("directional_led_colors", state.directional_led_colors);
  archive("tag_payloads", state.tag_payloads);
  archive("magnet_fields", state.magnet_fields);
  archive("range_and_bearing_data", state.range_and_bearing_data);
  archive_floor(archive, "floor", state.floor);
  archive.list("rays", state.rays, [&](Ray& ray) {
    math::archive_choice(archive, "kind", ray.kind, Ray::Kind::device);
    math::archive_index(archive, "robot", ray.robot, layout.robots.size());
    archive("start", ray.start);
    archive("end", ray.end);
    archive("hit", ray.hit);
  });
  archive.list("frusta", state.frusta, [&](Frustum& frustum) {
    math::archive_index(archive, "camera", frustum.camera, layout.cameras.size());
    archive("corners", frustum.corners);
  });
  archive_markers(archive, layout, state.markers);
}

namespace {

void archive_packets(math::Archive& archive, const Layout& layout, Observations& observations) {
  archive.list("range_and_bearing_data", observations.range_and_bearing_data);
  const std::size_t devices = layout.range_and_bearing.size();
  archive.list("range_and_bearing", observations.range_and_bearing,
               [&](RangeAndBearingPacket& packet) {
                 math::archive_index(archive, "receiver", packet.receiver, devices);
                 math::archive_index(archive, "sender", packet.sender, devices);
                 archive("range", packet.range);
                 archive("horizontal_bearing", packet.horizontal_bearing);
                 archive("vertical_bearing", packet.vertical_bearing);
                 archive_range(archive, packet.data.begin, packet.data.count,
                               observations.range_and_bearing_data.size());
               });
}

void archive_sights(math::Archive& archive, const Layout& layout, const State& state,
                    Observations& observations) {
  const auto led = [&](LedReading& reading) {
    math::archive_index(archive, "camera", reading.camera, layout.cameras.size());
    archive("color", reading.color);
    archive("center", reading.center);
  };
  archive.list("leds", observations.leds, led);
  archive.list("directional_leds", observations.directional_leds, led);
  archive.list("tags", observations.tags, [&](TagReading& reading) {
    math::archive_index(archive, "camera", reading.camera, layout.cameras.size());
    math::archive_index(archive, "tag", reading.tag, state.tag_payloads.size());
    archive("center", reading.center);
    archive("corners", reading.corners);
  });
  for (Image& image : observations.images) {
    archive.list("image", image.rgb);
    const auto [width, height] = layout.cameras[image.camera].resolution;
    const std::size_t size = std::size_t{3} * width * height;
    archive.require(image.rgb.empty() || image.rgb.size() == size,
                    "has another size than its camera");
  }
}

/// Rows of the described devices, which are in the layout's order.
void archive_rows(math::Archive& archive, const Layout& layout, std::vector<DeviceRows>& rows) {
  for (const DescribedDevice& device : layout.described) {
    if (device.rows.count == 0) continue;
    DeviceRows& read = rows[device.rows.begin];
    archive.list("device_rows", read.values);
    archive.require(read.values.size() % read.width == 0 && read.count() <= device.kind->most_rows,
                    "has half a row or too many");
  }
}

}  // namespace

void archive(math::Archive& archive, const Layout& layout, const State& state,
             Observations& observations) {
  static_assert(field_count<Observations>() == 19);
  archive("tick", observations.tick);
  archive("time_ns", observations.time_ns);
  archive("joint_readings", observations.joint_readings);
  archive_messages(archive, layout, observations.radio_messages);
  archive("proximity", observations.proximity);
  archive_packets(archive, layout, observations);
  archive("positioning", observations.positioning);
  for (BatteryReading& reading : observations.batteries) {
    archive("available_charge", reading.available_charge);
    archive.any_number("time_left", reading.time_left);  // infinite, if nothing is drawn
  }
  archive_sights(archive, layout, state, observations);
  archive("turrets", observations.turrets);
  archive("device_readings", observations.device_readings);
  archive_rows(archive, layout, observations.device_rows);
  for_each_channel(sensed, [&](auto i) {
    constexpr auto& channel = std::get<i>(sensed);
    auto& values = observations.*channel.values;
    using Reading = typename std::remove_reference_t<decltype(values)>::value_type;
    if constexpr (Numbers<Reading> && !std::is_same_v<Reading, BatteryReading>) {
      archive_numbers(archive, channel.recorded, values);
    }
  });
}

void archive(math::Archive& archive, const Layout& layout, Commands& commands) {
  static_assert(field_count<Commands>() == 15);
  archive("joint_targets", commands.joint_targets);
  archive("led_colors", commands.led_colors);
  archive("directional_led_colors", commands.directional_led_colors);
  archive("tag_payloads", commands.tag_payloads);
  archive("magnet_currents", commands.magnet_currents);
  archive("range_and_bearing_data", commands.range_and_bearing_data);
  archive_numbers(archive, "wheels", commands.wheels);
  for (TurretMode& mode : commands.turret_modes) {
    math::archive_choice(archive, "turret_mode", mode, TurretMode::speed);
  }
  archive("turret_rotations", commands.turret_rotations);
  archive("turret_speeds", commands.turret_speeds);
  archive_messages(archive, layout, commands.radio_messages);
  archive.list("pushes", commands.pushes, [&](Push& push) {
    math::archive_index(archive, "link", push.link, layout.links.size());
    archive("force", push.force);
    archive("torque", push.torque);
  });
  archive_floor(archive, "floor_paints", commands.floor_paints);
  archive_markers(archive, layout, commands.markers);
  archive("device_commands", commands.device_commands);
}

}  // namespace ziggurat::world
