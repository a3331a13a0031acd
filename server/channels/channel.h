// SPDX-License-Identifier: MIT
#pragma once
// Channel for viewers: a topic with messages of one type.

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <string>

#include "channels/schema.h"

namespace ziggurat::channels {

enum class Kind {
  world,
  poses,
  rays,
  detections,
  radio,
  contacts,
  barrier,
  phases,
  log,
  scene,
  transforms,
  observation,
  command,
  calibration,
  image,
  annotations,
  metrics,
};

using Kinds = std::bitset<static_cast<std::size_t>(Kind::metrics) + 1>;

constexpr std::size_t index_of(Kind kind) { return static_cast<std::size_t>(kind); }

/// Whether its messages are made of what robots sense.
constexpr bool shows_observations(Kind kind) {
  switch (kind) {
    case Kind::detections:
    case Kind::radio:
    case Kind::observation:
    case Kind::image:
    case Kind::annotations:
      return true;
    default:
      return false;
  }
}

/// When a channel has a message.
enum class Pace {
  latched,  ///< when it changes; a viewer that subscribes gets the newest one
  tick,     ///< at each tick
  answer,   ///< at each tick, when every controller has answered it
  event,    ///< now and then, from outside of the tick
};

constexpr Pace pace_of(Kind kind) {
  switch (kind) {
    case Kind::world:
    case Kind::scene:
    case Kind::calibration:
      return Pace::latched;
    case Kind::command:
      return Pace::answer;
    case Kind::barrier:
    case Kind::log:
    case Kind::metrics:
      return Pace::event;
    default:
      return Pace::tick;
  }
}

struct Channel {
  std::uint32_t id = 0;  ///< from 1 on; a topic keeps it as long as it exists
  std::string topic;
  Kind kind = Kind::world;
  const Schema* schema = nullptr;
  std::size_t place = 0;  ///< observation, command: into Layout::robots; of cameras: into
                          ///< Layout::cameras
};

}  // namespace ziggurat::channels
