// SPDX-License-Identifier: MIT
#pragma once
// The deadline policy of each robot, and the ticks that it missed.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "network/config.h"
#include "scene/deadline.h"

namespace ziggurat::network {

/// Action of a policy after a miss.
enum class Consequence {
  none,  ///< what was commanded before stays
  zero,  ///< its commands become zero when the tick is complete
  drop,  ///< it leaves the barrier for good
  stop,  ///< the run ends
};

/// The policy, if it is fixed and another than this one.
std::optional<scene::DeadlinePolicy> fixed_against(const Config::Deadline& deadline,
                                                   const scene::DeadlinePolicy& requested);

class Deadlines {
 public:
  Deadlines() = default;
  /// @param policies     per controller; missing: wait
  /// @param controllers  how many the scene has
  Deadlines(std::vector<Config::Deadline> policies, std::size_t controllers);

  /// One more robot, with the policy of its controller.
  void add(std::size_t controller);
  /// One more robot with a controller of its own.
  void grow(const Config::Deadline& deadline);
  /// Forgets robots behind the first `count`.
  void shrink(std::size_t count) { robots_.resize(count); }

  std::size_t controller(std::size_t robot) const { return robots_[robot].controller; }
  const scene::DeadlinePolicy& policy(std::size_t robot) const { return robots_[robot].policy; }
  /// Policy of the robot's controller, without its session's own policy.
  const scene::DeadlinePolicy& usual_policy(std::size_t robot) const {
    return defaults_[robots_[robot].controller].policy;
  }
  /// @param policy  none: that of the robot's controller
  void set_policy(std::size_t robot, const std::optional<scene::DeadlinePolicy>& policy);
  /// The policy of the robot's controller, if it is fixed and another than this one.
  std::optional<scene::DeadlinePolicy> fixed_against(std::size_t robot,
                                                     const scene::DeadlinePolicy& requested) const;

  /// The robot was not answered for in time. Counts that.
  Consequence miss(std::size_t robot, std::uint64_t tick);
  std::uint32_t misses_in_row(std::size_t robot) const { return robots_[robot].misses_in_row; }
  /// The robot was answered for in time.
  void forgive(std::size_t robot) { robots_[robot].misses_in_row = 0; }
  /// Whether its commands become zero when the tick is complete.
  bool is_zeroed(std::size_t robot) const { return robots_[robot].is_zeroed; }
  void clear_zero(std::size_t robot) { robots_[robot].is_zeroed = false; }
  /// The world begins anew: no robot has missed a tick of it. The ticks of before stay counted.
  void reset();

  /// Per controller: ticks at which one of its robots or more missed a deadline.
  const std::vector<std::uint64_t>& missed_ticks() const { return missed_ticks_; }

 private:
  struct Robot {
    std::size_t controller = 0;
    scene::DeadlinePolicy policy;
    std::uint32_t misses_in_row = 0;
    std::optional<std::uint64_t> last_missed;  // tick, which counts once
    bool is_zeroed = false;
  };

  std::vector<Config::Deadline> defaults_;                 // per controller of the scene
  std::vector<Robot> robots_;                              // per robot of the layout
  std::vector<std::uint64_t> missed_ticks_;                // per controller of the scene
  std::vector<std::optional<std::uint64_t>> last_missed_;  // likewise: the last of them
};

}  // namespace ziggurat::network
