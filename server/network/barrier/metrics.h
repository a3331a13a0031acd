// SPDX-License-Identifier: MIT
#pragma once
// The metrics that sessions have set: at the current tick, and last.

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "wire/messages.h"

namespace ziggurat::network {

class Metrics {
 public:
  static constexpr std::size_t most_names = 100;  ///< of a robot in a run

  /// Why these can't be set, if they can't: a robot would have too many names.
  std::optional<wire::Fault> check(const std::vector<wire::Metric>& metrics) const;
  /// The last value of a name counts. @param metrics  checked
  void set(const std::vector<wire::Metric>& metrics);

  void begin_tick() { of_tick_.clear(); }
  /// The world begins anew.
  void clear();

  // Metrics of robots in scene order, sorted by name for each robot.
  std::vector<wire::Metric> of_tick() const;
  std::vector<wire::Metric> last() const;

 private:
  using Key = std::pair<std::size_t, std::string>;  // robot and name
  std::map<Key, double> last_, of_tick_;
  std::map<std::size_t, std::size_t> names_;  // how many each robot has
};

}  // namespace ziggurat::network
