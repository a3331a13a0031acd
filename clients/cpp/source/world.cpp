// SPDX-License-Identifier: MIT
#include "world.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "channel.h"
#include "convert.h"

namespace ziggurat {
namespace {

constexpr std::int32_t floor_place = -1;  // of a contact's link; others below 0 are not told

/// The numbers of an array as states, which have these numbers in this order and nothing else.
template <typename T>
void read_states(const google::protobuf::RepeatedField<double>& from, std::vector<T>& to) {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(double) == 0);
  to.resize(size(from.size()) * sizeof(double) / sizeof(T));
  if (!to.empty()) std::memcpy(static_cast<void*>(to.data()), from.data(), to.size() * sizeof(T));
}

void read_colors(const google::protobuf::RepeatedField<std::uint32_t>& from,
                 std::vector<Color>& to) {
  to.resize(size(from.size()));
  std::ranges::transform(from, to.begin(), color_of);
}

/// @param each  numbers of one
void expect_all_or_none(int received, std::size_t each, std::size_t count, const char* what) {
  if (received != 0) expect(size(received), each * count, what);
}

template <typename T>
std::span<const T> part_of(const std::vector<T>& all, std::size_t first, std::size_t count) {
  // Nothing that was asked for, or of an entity of an earlier world.
  if (first + count > all.size()) return {};
  return std::span(all).subspan(first, count);
}

std::string id_of(const std::string& id) { return id; }
template <typename Description>
std::string id_of(const Description& description) {
  return description.id();
}

}  // namespace

const Pose& Entity::pose() const {
  if (place_ < world_->poses_.size()) return world_->poses_[place_];
  throw std::logic_error("the director was not told poses; add Group::poses to its groups");
}

std::span<const LinkState> Entity::links() const noexcept {
  return part_of(world_->links_, links_.first, links_.ids.size());
}
std::span<const JointState> Entity::joints() const noexcept {
  return part_of(world_->joints_, joints_.first, joints_.ids.size());
}
std::span<const Color> Entity::leds() const noexcept {
  return part_of(world_->leds_, leds_.first, leds_.ids.size());
}
std::span<const Color> Entity::directional_leds() const noexcept {
  return part_of(world_->directional_leds_, directional_leds_.first, directional_leds_.ids.size());
}
std::span<const std::string_view> Entity::tags() const noexcept {
  return part_of(world_->tags_, tags_.first, tags_.ids.size());
}
std::span<const std::array<double, 3>> Entity::magnets() const noexcept {
  return part_of(world_->magnets_, magnets_.first, magnets_.ids.size());
}

const Entity* World::find(std::string_view id) const {
  const auto found = by_id_.find(id);
  return found == by_id_.end() ? nullptr : found->second;
}

namespace {

template <typename Descriptions>
bool has_ids(std::span<const std::string> ids, const Descriptions& descriptions) {
  return std::equal(ids.begin(), ids.end(), descriptions.begin(), descriptions.end(),
                    [](const std::string& id, const auto& each) { return id == id_of(each); });
}

}  // namespace

/// After a reset or over another connection the same entities may be told again: their handles
/// stay. What was spawned since may have the id of another one.
bool World::is_as_before(const v1::WorldLayout& layout) const {
  return std::equal(entities_.begin(), entities_.end(), layout.entities().begin(),
                    layout.entities().end(),
                    [](const Entity& ours, const v1::EntityDescription& theirs) {
                      return ours.id_ == theirs.id() && ours.kind_ == theirs.kind() &&
                             ours.controller_ == theirs.controller() &&
                             has_ids(ours.links_.ids, theirs.links()) &&
                             has_ids(ours.joints_.ids, theirs.joints()) &&
                             has_ids(ours.leds_.ids, theirs.leds()) &&
                             has_ids(ours.directional_leds_.ids, theirs.directional_leds()) &&
                             has_ids(ours.tags_.ids, theirs.tags()) &&
                             has_ids(ours.magnets_.ids, theirs.magnets()) &&
                             has_ids(ours.radios_.ids, theirs.radios());
                    });
}

void World::begin_anew() {
  present_.clear();
  by_id_.clear();
  link_places_.clear();
  radio_places_.clear();
  contacts_.clear();
  messages_.clear();
  counts_ = {};
  former_ = std::exchange(entities_, {});
  for (Entity& entity : former_) entity.is_removed_ = true;
}

void World::read(const v1::WorldLayout& layout) {
  has_new_layout_ = true;
  const bool is_new = layout.first() == 0;
  if (is_new && is_as_before(layout)) {
    for (Entity& entity : entities_) entity.is_removed_ = false;
  } else {
    if (is_new) begin_anew();
    expect(layout.first(), entities_.size(), "entities before those of a layout");
    for (const auto& description : layout.entities()) add(description);
  }
  for (const std::uint32_t place : layout.removed()) {
    if (place < entities_.size()) entities_[place].is_removed_ = true;
  }
  present_.clear();
  by_id_.clear();
  for (Entity& entity : entities_) {
    if (entity.is_removed_) continue;
    present_.push_back(&entity);
    by_id_[entity.id_] = &entity;
  }
}

void World::add(const v1::EntityDescription& from) {
  Entity& entity = entities_.emplace_back();
  entity.world_ = this;
  entity.place_ = entities_.size() - 1;
  entity.id_ = from.id();
  entity.kind_ = from.kind();
  entity.controller_ = from.controller();
  const auto read_part = [](const auto& descriptions, Entity::Part& part, std::size_t& count) {
    part.first = count;
    for (const auto& each : descriptions) part.ids.push_back(id_of(each));
    count += part.ids.size();
  };
  read_part(from.links(), entity.links_, counts_.links);
  read_part(from.joints(), entity.joints_, counts_.joints);
  read_part(from.leds(), entity.leds_, counts_.leds);
  read_part(from.directional_leds(), entity.directional_leds_, counts_.directional_leds);
  read_part(from.tags(), entity.tags_, counts_.tags);
  read_part(from.magnets(), entity.magnets_, counts_.magnets);
  read_part(from.radios(), entity.radios_, counts_.radios);
  for (std::size_t i = 0; i < entity.links_.ids.size(); ++i) link_places_.push_back({&entity, i});
  for (std::size_t i = 0; i < entity.radios_.ids.size(); ++i) radio_places_.push_back({&entity, i});
}

void World::check(const v1::WorldState& state) const {
  expect_all_or_none(state.poses_size(), 7, entities_.size(), "numbers of poses");
  expect_all_or_none(state.links_size(), 13, counts_.links, "numbers of links");
  expect_all_or_none(state.joints_size(), 2, counts_.joints, "numbers of joints");
  expect_all_or_none(state.led_colors_size(), 1, counts_.leds, "colors of LEDs");
  expect_all_or_none(state.directional_led_colors_size(), 1, counts_.directional_leds,
                     "colors of directional LEDs");
  expect_all_or_none(state.tag_payloads_size(), 1, counts_.tags, "payloads of tags");
  expect_all_or_none(state.magnets_size(), 3, counts_.magnets, "numbers of magnets");
  const std::size_t contacts = size(state.contact_links_size()) / 2;
  expect(size(state.contact_links_size()), 2 * contacts, "links of contacts");
  expect(size(state.contacts_size()), 9 * contacts, "numbers of contacts");
  const auto links = static_cast<std::int64_t>(counts_.links);
  for (int i = 0; i < state.contact_links_size(); ++i) {
    if (state.contact_links(i) >= links || (i % 2 == 0 && state.contact_links(i) < 0)) {
      throw std::runtime_error("the server sent a contact of a link that it had not announced");
    }
  }
  for (const v1::ReceivedMessage& message : state.radio_messages()) {
    if (message.radio() >= counts_.radios ||
        message.sender() >= static_cast<std::int64_t>(counts_.radios)) {
      throw std::runtime_error("the server sent a message of a radio that it had not announced");
    }
  }
}

void World::read(const v1::WorldState& state) {
  check(state);
  has_changed_ = std::exchange(has_new_layout_, false);
  read_states(state.poses(), poses_);
  read_states(state.links(), links_);
  read_states(state.joints(), joints_);
  read_states(state.magnets(), magnets_);
  read_colors(state.led_colors(), leds_);
  read_colors(state.directional_led_colors(), directional_leds_);
  tags_.assign(state.tag_payloads().begin(), state.tag_payloads().end());
  read_contacts(state);
  read_messages(state);
}

void World::read_contacts(const v1::WorldState& state) {
  contacts_.resize(size(state.contact_links_size()) / 2);
  const double* number = state.contacts().data();
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const std::int32_t first = state.contact_links(static_cast<int>(2 * i));
    const std::int32_t second = state.contact_links(static_cast<int>(2 * i + 1));
    const Place& place = link_places_[static_cast<std::size_t>(first)];
    Contact& contact = contacts_[i] = {};
    contact.first = place.entity;
    contact.first_link = place.number;
    contact.is_with_floor = second == floor_place;
    if (second >= 0) {
      const Place& other = link_places_[static_cast<std::size_t>(second)];
      contact.second = other.entity;
      contact.second_link = other.number;
    }
    for (auto* vector : {&contact.point, &contact.normal, &contact.force}) {
      std::copy_n(number, vector->size(), vector->begin());
      number += vector->size();
    }
  }
}

void World::read_messages(const v1::WorldState& state) {
  messages_.clear();
  for (const v1::ReceivedMessage& from : state.radio_messages()) {
    const Place& receiver = radio_places_[from.radio()];
    RadioMessage& message = messages_.emplace_back();
    message.receiver = receiver.entity;
    message.receiving_radio = receiver.number;
    if (from.sender() >= 0) {
      const Place& sender = radio_places_[static_cast<std::size_t>(from.sender())];
      message.sender = sender.entity;
      message.sending_radio = sender.number;
    }
    message.payload = bytes_of(from.payload());
  }
}

}  // namespace ziggurat
