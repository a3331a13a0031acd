#pragma once
// Commands as the topic /inputs has them: what has changed since the ticks before.

#include "world/commands.h"
#include "ziggurat/v1/run.pb.h"

namespace ziggurat::recorder {

class CommandChanges {
 public:
  /// The arrays that differ from those of the call before, bit by bit, and all radio messages.
  void fill(const world::Commands& from, v1::Commands& to);
  /// The next call writes all arrays.
  void forget() { is_first_ = true; }

 private:
  world::Commands before_;
  bool is_first_ = true;
};

}  // namespace ziggurat::recorder
