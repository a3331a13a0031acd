// SPDX-License-Identifier: MIT
#include "channels/exchanged.h"

#include <span>

#include "channels/packing.h"
#include "wire/command.h"
#include "wire/devices.h"
#include "wire/observation.h"

namespace ziggurat::channels {
namespace {

template <class Message>
void begin(const Moment& moment, Message& message) {
  message.Clear();
  message.set_tick(moment.state.tick);
  message.set_time_ns(moment.state.time_ns);
}

void assign(std::string& to, std::span<const std::uint8_t> from) {
  to.assign(reinterpret_cast<const char*>(from.data()), from.size());
}

/// The entry of a camera; readings ascend by camera within each kind.
v1::Detections::Camera& camera_in(v1::Detections& detections, std::size_t camera) {
  for (auto& known : *detections.mutable_cameras()) {
    if (known.camera() == camera) return known;
  }
  v1::Detections::Camera& added = *detections.add_cameras();
  added.set_camera(index(camera));
  return added;
}

void set_light(const world::LedReading& from, v1::Detections::Light& to) {
  to.set_color(from.color);
  to.set_u(from.center.x());
  to.set_v(from.center.y());
}

}  // namespace

void fill(const Moment& moment, v1::Rays& rays) {
  begin(moment, rays);
  for (const world::Ray& ray : moment.rays.value_or(std::span(moment.state.rays))) {
    rays.add_kinds(static_cast<v1::Rays::Kind>(ray.kind));  // the same numbers
    rays.add_robots(index(ray.robot));
    add(ray.start, *rays.mutable_segments());
    add(ray.end, *rays.mutable_segments());
    rays.add_hits(ray.hit);
  }
  for (const world::Marker& marker : moment.state.markers) {
    wire::write(marker, marker.robot, *rays.add_markers());
  }
}

void fill(const Moment& moment, v1::Detections& detections) {
  begin(moment, detections);
  for (const auto& led : moment.observations.leds) {
    set_light(led, *camera_in(detections, led.camera).add_leds());
  }
  for (const auto& led : moment.observations.directional_leds) {
    set_light(led, *camera_in(detections, led.camera).add_directional_leds());
  }
  for (const world::TagReading& tag : moment.observations.tags) {
    v1::Detections::SeenTag& seen = *camera_in(detections, tag.camera).add_tags();
    seen.set_tag(index(tag.tag));
    seen.set_payload(moment.state.tag_payloads[tag.tag]);
    seen.set_u(tag.center.x());
    seen.set_v(tag.center.y());
    for (const auto& corner : tag.corners) {
      seen.add_corners(corner.x());
      seen.add_corners(corner.y());
    }
  }
}

void fill(const Moment& moment, v1::RadioTraffic& traffic) {
  begin(moment, traffic);
  const world::Observations& seen = moment.observations;
  for (const auto& entry : seen.radio_messages.entries) {
    v1::RadioTraffic::Delivery& delivery = *traffic.add_messages();
    delivery.set_sender(index(entry.sender));
    delivery.set_receiver(index(entry.radio));
    assign(*delivery.mutable_payload(), seen.radio_messages.payload(entry));
  }
  const std::span data(seen.range_and_bearing_data);
  for (const world::RangeAndBearingPacket& heard : seen.range_and_bearing) {
    v1::RadioTraffic::Packet& packet = *traffic.add_packets();
    packet.set_sender(index(heard.sender));
    packet.set_receiver(index(heard.receiver));
    assign(*packet.mutable_data(), data.subspan(heard.data.begin, heard.data.count));
    packet.set_range(heard.range);
    packet.set_horizontal_bearing(heard.horizontal_bearing);
    packet.set_vertical_bearing(heard.vertical_bearing);
  }
}

void fill(const Moment& moment, v1::Contacts& contacts) {
  begin(moment, contacts);
  for (const world::Contact& contact : moment.contacts) {
    contacts.add_links(static_cast<std::int32_t>(contact.link));
    contacts.add_links(contact.other ? static_cast<std::int32_t>(*contact.other) : -1);
    add(contact.point, *contacts.mutable_points());
    add(contact.normal, *contacts.mutable_normals());
    add(contact.force, *contacts.mutable_forces());
  }
}

void fill(const wire::Roster& robot, const Moment& moment, v1::Observation& to) {
  to.Clear();
  wire::fill(robot, moment.observations, moment.state.tag_payloads, to);
}

void fill(const wire::Roster& robot, const world::Layout& layout, const Moment& moment,
          v1::Command& command) {
  command.Clear();
  command.set_tick(moment.state.tick);
  wire::add_channels(robot, moment.commands, command);
  const world::Range& radios = layout.robots[robot.robots.front()].radios;
  const world::RadioMessages& sent = moment.commands.radio_messages;
  for (const auto& entry : sent.entries) {
    if (entry.radio < radios.begin || entry.radio >= radios.end()) continue;
    v1::RadioMessage& message = *command.add_radio_messages();
    message.set_radio(index(entry.radio - radios.begin));
    const auto payload = sent.payload(entry);
    message.set_payload(payload.data(), payload.size());
  }
  for (const world::Marker& marker : moment.state.markers) {
    if (marker.robot == robot.robots.front()) wire::write(marker, 0, *command.add_markers());
  }
}

}  // namespace ziggurat::channels
