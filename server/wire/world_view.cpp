// SPDX-License-Identifier: MIT
#include "wire/world_view.h"

#include <algorithm>

#include "scene/joint_coordinates.h"
#include "ziggurat/v1/envelope.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {
namespace {

using Numbers = google::protobuf::RepeatedField<double>;

void append(const math::Vector3& from, Numbers& to) {
  for (const double value : from) to.Add(value);
}

void append(const math::Pose& from, Numbers& to) {
  for (const double value : world::numbers(from)) to.Add(value);
}

/// Calls visit(index into the layout's list) for each device of a kind that an entity carries. The
/// lists ascend by entity.
template <class Device, class Visit>
void for_each_of(const std::vector<Device>& devices, std::size_t entity, Visit visit) {
  auto device = std::ranges::lower_bound(devices, entity, {},
                                         [](const Device& each) { return each.mount.entity; });
  for (; device != devices.end() && device->mount.entity == entity; ++device) {
    visit(static_cast<std::size_t>(device - devices.begin()));
  }
}

scene::LinkMotion motion_of(const world::LinkState& link) {
  return {link.pose, link.velocity, link.angular_velocity};
}

void describe(const Truth& truth, std::size_t index,
              const std::vector<scene::Controller>& controllers, v1::EntityDescription& to) {
  const world::Layout& layout = truth.layout;
  const world::EntityLayout& entity = layout.entities[index];
  const scene::Entity& placed = truth.entities[index];
  to.set_id(v1::valid_utf8(entity.id));
  to.set_kind(std::string(scene::to_string(placed.kind)));
  if (placed.controller) to.set_controller(v1::valid_utf8(controllers[*placed.controller].id));
  for (std::size_t i = entity.links.begin; i < entity.links.end(); ++i) {
    to.add_links(v1::valid_utf8(layout.links[i].id));
  }
  for (const scene::Joint& joint : placed.joints) {
    if (scene::has_coordinate(joint.type)) to.add_joints(v1::valid_utf8(joint.id));
  }
  const auto add_led = [](const auto& led, v1::LedDescription& description) {
    description.set_id(v1::valid_utf8(led.id));
    description.set_color(led.color);
  };
  for (std::size_t i = entity.leds.begin; i < entity.leds.end(); ++i) {
    add_led(layout.leds[i], *to.add_leds());
  }
  for (std::size_t i = entity.directional_leds.begin; i < entity.directional_leds.end(); ++i) {
    add_led(layout.directional_leds[i], *to.add_directional_leds());
  }
  for (std::size_t i = entity.tags.begin; i < entity.tags.end(); ++i) {
    v1::TagDescription& tag = *to.add_tags();
    tag.set_id(v1::valid_utf8(layout.tags[i].id));
    tag.set_payload(layout.tags[i].payload);
  }
  for_each_of(layout.magnets, index, [&](std::size_t i) {
    to.add_magnets()->set_id(v1::valid_utf8(layout.magnets[i].id));
  });
  for_each_of(layout.radios, index, [&](std::size_t i) {
    const world::RadioLayout& from = layout.radios[i];
    v1::RadioDescription& radio = *to.add_radios();
    radio.set_id(v1::valid_utf8(from.id));
    radio.set_range(from.range);
    radio.set_sends(from.sends);
    radio.set_receives(from.receives);
  });
}

void add_joints(const Truth& truth, std::size_t entity, Numbers& to) {
  const std::size_t first = truth.layout.entities[entity].links.begin;
  for (const scene::Joint& joint : truth.entities[entity].joints) {
    if (!scene::has_coordinate(joint.type)) continue;
    const world::LinkState& parent = truth.state.links[first + joint.parent];
    const world::LinkState& child = truth.state.links[first + joint.child];
    to.Add(scene::position_of(joint, parent.pose, child.pose));
    to.Add(scene::velocity_of(joint, motion_of(parent), motion_of(child)));
  }
}

void add_links(const Truth& truth, const world::Range& links, Numbers& to) {
  for (std::size_t i = links.begin; i < links.end(); ++i) {
    const world::LinkState& link = truth.state.links[i];
    append(link.pose, to);
    append(link.velocity, to);
    append(link.angular_velocity, to);
  }
}

void add_radio_messages(const WorldView& view, const Truth& truth, v1::WorldState& to) {
  const world::RadioMessages& messages = truth.observations.radio_messages;
  for (const auto& entry : messages.entries) {
    const std::int32_t place = view.radio_places[entry.radio];
    if (place < 0) continue;
    v1::ReceivedMessage& message = *to.add_radio_messages();
    message.set_radio(static_cast<std::uint32_t>(place));
    message.set_sender(view.radio_places[entry.sender]);
    const auto payload = messages.payload(entry);
    message.set_payload(payload.data(), payload.size());
  }
}

void add_contacts(const WorldView& view, const Truth& truth, v1::WorldState& to) {
  for (const world::Contact& contact : truth.contacts) {
    const std::int32_t link = view.link_places[contact.link];
    const std::int32_t other =
        contact.other ? view.link_places[*contact.other] : WorldView::the_floor;
    if (link < 0 && other < 0) continue;
    // The first one is told: where only the other is, the contact is turned round.
    const bool is_turned = link < 0;
    const double sign = is_turned ? -1 : 1;
    to.add_contact_links(is_turned ? other : link);
    to.add_contact_links(is_turned ? link : other);
    append(contact.point, *to.mutable_contacts());
    append(sign * contact.normal, *to.mutable_contacts());
    append(sign * contact.force, *to.mutable_contacts());
  }
}

}  // namespace

void consider(WorldView& view, const Truth& truth, std::size_t entity, bool is_wanted) {
  const world::Layout& layout = truth.layout;
  view.considered = entity + 1;
  view.link_places.resize(layout.links.size(), WorldView::elsewhere);
  view.radio_places.resize(layout.radios.size(), WorldView::elsewhere);
  if (!is_wanted) return;
  view.entities.push_back(entity);
  view.removed.push_back(false);
  const world::Range& links = layout.entities[entity].links;
  for (std::size_t i = links.begin; i < links.end(); ++i) view.link_places[i] = view.link_count++;
  for_each_of(layout.magnets, entity, [&](std::size_t i) { view.magnets.push_back(i); });
  for_each_of(layout.radios, entity, [&](std::size_t i) {
    view.radio_places[i] = static_cast<std::int32_t>(view.radios.size());
    view.radios.push_back(i);
  });
}

bool has_news(const WorldView& view, const world::State& state) {
  if (view.is_new || view.told < view.entities.size()) return true;
  for (std::size_t i = 0; i < view.entities.size(); ++i) {
    if (!view.removed[i] && state.is_absent(view.entities[i])) return true;
  }
  return false;
}

bool fill(WorldView& view, const Truth& truth, const std::vector<scene::Controller>& controllers,
          std::size_t limit, v1::WorldLayout& to) {
  to.set_first(static_cast<std::uint32_t>(view.told));
  std::size_t size = 0;
  for (std::size_t i = view.told; i < view.entities.size(); ++i) {
    v1::EntityDescription& description = *to.add_entities();
    describe(truth, view.entities[i], controllers, description);
    size += description.ByteSizeLong();
    if (size > limit) return false;
  }
  for (std::size_t i = 0; i < view.entities.size(); ++i) {
    if (view.removed[i] || !truth.state.is_absent(view.entities[i])) continue;
    view.removed[i] = true;
    to.add_removed(static_cast<std::uint32_t>(i));
  }
  view.told = view.entities.size();
  view.is_new = false;
  return true;
}

ReadingSize size_of_readings(const WorldView& view, const Truth& truth) {
  ReadingSize size;
  const Subscription& wanted = view.subscription;
  if (wanted.radio_messages) {
    for (const auto& entry : truth.observations.radio_messages.entries) {
      if (view.radio_places[entry.radio] < 0) continue;
      size.size += 2;
      size.add_payload(entry.size);
    }
  }
  for (const std::size_t index : view.entities) {
    const world::EntityLayout& entity = truth.layout.entities[index];
    if (wanted.leds) size.size += entity.leds.count + entity.directional_leds.count;
    const world::Range& tags = entity.tags;
    for (std::size_t t = tags.begin; wanted.tags && t < tags.end(); ++t) {
      size.size += 2;
      size.add_payload(truth.state.tag_payloads[t].size());
    }
  }
  return size;
}

void fill(const WorldView& view, const Truth& truth, v1::WorldState& to) {
  const Subscription& wanted = view.subscription;
  const world::State& state = truth.state;
  to.set_tick(state.tick);
  to.set_time_ns(state.time_ns);
  for (const std::size_t index : view.entities) {
    const world::EntityLayout& entity = truth.layout.entities[index];
    if (wanted.poses) append(state.origins[index], *to.mutable_poses());
    if (wanted.links) add_links(truth, entity.links, *to.mutable_links());
    if (wanted.joints) add_joints(truth, index, *to.mutable_joints());
    for (std::size_t i = entity.leds.begin; wanted.leds && i < entity.leds.end(); ++i) {
      to.add_led_colors(state.led_colors[i]);
    }
    const world::Range& directional = entity.directional_leds;
    for (std::size_t i = directional.begin; wanted.leds && i < directional.end(); ++i) {
      to.add_directional_led_colors(state.directional_led_colors[i]);
    }
    for (std::size_t i = entity.tags.begin; wanted.tags && i < entity.tags.end(); ++i) {
      to.add_tag_payloads(state.tag_payloads[i]);
    }
  }
  if (wanted.magnets) {
    for (const std::size_t magnet : view.magnets)
      append(state.magnet_fields[magnet], *to.mutable_magnets());
  }
  if (wanted.radio_messages) add_radio_messages(view, truth, to);
  if (wanted.contacts) add_contacts(view, truth, to);
}

}  // namespace ziggurat::wire
