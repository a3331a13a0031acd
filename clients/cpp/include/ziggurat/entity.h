// SPDX-License-Identifier: MIT
#pragma once
// An entity of the world as a director is told of it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ziggurat/actuators.h"
#include "ziggurat/radio.h"

namespace ziggurat {

/// Occupants that the place of a moved entity may have.
enum class Onto {
  free_place,  ///< nothing: a move onto others is not done
  others,      ///< others, too: what overlaps is pushed apart
};

/// In the world's frame.
struct Pose {
  std::array<double, 3> position;     ///< x, y, z [m]
  std::array<double, 4> orientation;  ///< unit quaternion w, x, y, z
};

/// State of a link's frame, in the world's.
struct LinkState {
  std::array<double, 3> position;          ///< [m]
  std::array<double, 4> orientation;       ///< unit quaternion w, x, y, z
  std::array<double, 3> velocity;          ///< [m/s]
  std::array<double, 3> angular_velocity;  ///< [rad/s]
};

struct JointState {
  double position;  ///< [m], or [rad] from -pi to pi
  double velocity;  ///< [m/s] or [rad/s]
};

/// A handle into its director. When the world begins anew with other entities (Event::reset,
/// Event::restored, or a session that was resumed), earlier handles are of removed entities: look
/// them up again. Lists of states are as long as those of ids, and empty if the director did not
/// ask for them (DirectorOptions::groups).
class Entity {
 public:
  const std::string& id() const noexcept { return id_; }
  const std::string& kind() const noexcept { return kind_; }  ///< its element: `box`, `foot-bot`, …
  /// Id of its controller in the scene; empty if it has none.
  const std::string& controller() const noexcept { return controller_; }
  /// It is not in the world any more: its states mean nothing.
  bool is_removed() const noexcept { return is_removed_; }

  /// Pose of its origin. @throws std::logic_error if the director did not ask for poses
  const Pose& pose() const;

  std::span<const std::string> link_ids() const noexcept {
    return links_.ids;
  }  ///< of one body: ""
  std::span<const LinkState> links() const noexcept;
  std::span<const std::string> joint_ids() const noexcept { return joints_.ids; }
  std::span<const JointState> joints() const noexcept;
  std::span<const Color> leds() const noexcept;
  std::span<const Color> directional_leds() const noexcept;
  std::span<const std::string_view> tags() const noexcept;  ///< payloads; valid until next()
  /// The field of each magnet in its anchor's frame.
  std::span<const std::array<double, 3>> magnets() const noexcept;
  std::span<const std::string> radio_ids() const noexcept { return radios_.ids; }

 private:
  friend class World;
  struct Part {  // of a flat array
    std::size_t first = 0;
    std::vector<std::string> ids;
  };
  const class World* world_ = nullptr;
  std::size_t place_ = 0;
  std::string id_, kind_, controller_;
  Part links_, joints_, leds_, directional_leds_, tags_, magnets_, radios_;
  bool is_removed_ = false;
};

/// In the last substep of the tick.
struct Contact {
  const Entity* first = nullptr;
  std::size_t first_link = 0;  ///< place in first->link_ids()
  /// Null: the floor, or an entity that the director did not ask for.
  const Entity* second = nullptr;
  std::size_t second_link = 0;
  bool is_with_floor = false;
  std::array<double, 3> point;   ///< in the world [m]
  std::array<double, 3> normal;  ///< from the second to the first
  std::array<double, 3> force;   ///< on the first [N]
};

/// A radio message that arrived at this tick.
struct RadioMessage {
  const Entity* receiver = nullptr;
  std::size_t receiving_radio = 0;  ///< place in receiver->radio_ids()
  const Entity* sender = nullptr;   ///< null: an entity that the director did not ask for
  std::size_t sending_radio = 0;
  Bytes payload;  ///< valid until next()
};

}  // namespace ziggurat
