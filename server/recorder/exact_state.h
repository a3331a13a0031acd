#pragma once
// Poses and velocities as the topic /state has them: of the links that have changed.

#include <array>
#include <vector>

#include "world/state.h"
#include "ziggurat/v1/run.pb.h"

namespace ziggurat::recorder {

class StateChanges {
 public:
  /// The links that differ from those of the call before, bit by bit.
  /// @param to  is cleared; keeps its memory
  void fill(const world::State& from, v1::ExactState& to);
  /// The next call writes all links.
  void forget() { before_.clear(); }

 private:
  using Link = std::array<double, 13>;  // as in ExactState.values
  std::vector<Link> before_;
};

}  // namespace ziggurat::recorder
