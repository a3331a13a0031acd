#pragma once
// Radios: the messages of a step leave at the start of the next tick.

#include <vector>

#include "devices/tick.h"
#include "media/radio.h"

namespace ziggurat::devices {

class Radios {
 public:
  explicit Radios(const Setting& setting) { add(setting); }

  void add(const Setting& setting);

  /// Delivers what was commanded and empties it; publishes links that somebody asks for.
  void apply(Tick& tick);

  bool needs_index() const { return needs_index_; }

 private:
  media::RadioMedium medium_;
  std::vector<std::size_t> robots_;  // per radio, into Layout::robots
  bool needs_index_ = false;         // somebody sends and somebody receives
};

}  // namespace ziggurat::devices
