// SPDX-License-Identifier: MIT
#include "channels/copies.h"

#include <type_traits>

namespace ziggurat::channels {

Moment TickCopy::view() const {
  Moment moment{state, observations, commands, contacts, phases};
  if (rays) moment.rays = *rays;
  moment.has_observations = has_observations;
  return moment;
}

namespace {

void copy_observations(const Moment& from, Sensed sensed, TickCopy& to) {
  world::for_each_row(world::sensed, [&](auto i) {
    constexpr auto& row = std::get<i>(world::sensed);
    using Field = std::remove_cvref_t<decltype(to.observations.*row.values)>;
    if (std::is_same_v<Field, std::vector<world::Image>> &&
        sensed != Sensed::numbers_and_pictures) {
      (to.observations.*row.values) = {};
    } else {
      to.observations.*row.values = from.observations.*row.values;
    }
  });
}

}  // namespace

void copy(const Moment& from, Sensed sensed, TickCopy& to) {
  to.state = from.state;
  to.has_observations = sensed != Sensed::nothing;
  if (to.has_observations) copy_observations(from, sensed, to);
  to.commands = from.commands;
  to.contacts.assign(from.contacts.begin(), from.contacts.end());
  to.phases = from.phases;
  if (!from.rays) {
    to.rays.reset();
  } else if (to.rays) {
    to.rays->assign(from.rays->begin(), from.rays->end());
  } else {
    to.rays.emplace(from.rays->begin(), from.rays->end());
  }
}

std::size_t size_of(const TickCopy& copy) {
  const world::Observations& sensed = copy.observations;
  std::size_t size = sizeof copy;
  for (const world::Image& image : sensed.images) size += image.rgb.size();
  for (const std::string& payload : copy.state.tag_payloads) size += payload.size();
  size += copy.state.links.size() * sizeof(world::LinkState);
  size += copy.state.origins.size() * sizeof(math::Pose);
  size += copy.state.rays.size() * sizeof(world::Ray);
  if (copy.rays) size += copy.rays->size() * sizeof(world::Ray);
  size += sensed.radio_messages.bytes.size() + copy.commands.radio_messages.bytes.size();
  size += sensed.range_and_bearing_data.size();
  size += copy.contacts.size() * sizeof(world::Contact);
  size += (copy.state.markers.size() + copy.commands.markers.size()) * sizeof(world::Marker);
  return size;
}

}  // namespace ziggurat::channels
