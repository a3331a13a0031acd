// SPDX-License-Identifier: MIT
#pragma once
// The entities that a director is told of, and their states after a tick; knows messages, but no
// connection.

#include <deque>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "ziggurat/entity.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat {

class World {
 public:
  World() = default;
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// @throws std::runtime_error if it does not follow what was told before
  void read(const v1::WorldLayout& layout);
  /// The message stays unchanged until the next is read: states point into it.
  /// @throws std::runtime_error if it is not what the layout announced; nothing is read
  void read(const v1::WorldState& state);

  std::span<Entity* const> present() const { return present_; }
  bool has_changed() const { return has_changed_; }  ///< since the state before
  const Entity* find(std::string_view id) const;
  std::span<const Contact> contacts() const { return contacts_; }
  std::span<const RadioMessage> radio_messages() const { return messages_; }

 private:
  friend class Entity;
  struct Place {  // of a link or a radio
    const Entity* entity = nullptr;
    std::size_t number = 0;
  };
  /// Number of parts of each kind that all entities have together.
  struct Counts {
    std::size_t links = 0, joints = 0, leds = 0, directional_leds = 0, tags = 0, magnets = 0,
                radios = 0;
  };

  void begin_anew();
  void add(const v1::EntityDescription& description);
  bool is_as_before(const v1::WorldLayout& layout) const;
  void check(const v1::WorldState& state) const;
  void read_contacts(const v1::WorldState& state);
  void read_messages(const v1::WorldState& state);

  std::deque<Entity> entities_;  // by place; these do not move
  std::deque<Entity>
      former_;  // of the world before: a handle that is kept for too long is of one that is gone
  std::vector<Entity*> present_;
  std::unordered_map<std::string_view, Entity*> by_id_;
  std::vector<Place> link_places_, radio_places_;
  Counts counts_;
  bool has_new_layout_ = false, has_changed_ = false;

  // State at the current tick, empty if the director did not ask for it.
  std::vector<Pose> poses_;
  std::vector<LinkState> links_;
  std::vector<JointState> joints_;
  std::vector<Color> leds_, directional_leds_;
  std::vector<std::string_view> tags_;
  std::vector<std::array<double, 3>> magnets_;
  std::vector<Contact> contacts_;
  std::vector<RadioMessage> messages_;
};

}  // namespace ziggurat
