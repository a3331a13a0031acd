#include "wire/positions.h"

#include <fmt/format.h>

#include <vector>

#include "wire/fault.h"

namespace ziggurat::wire {

std::optional<Fault> check_positions(const google::protobuf::RepeatedField<std::uint32_t>& robots,
                                     const Roster& roster, const world::Layout& layout) {
  std::vector<bool> named(robots.empty() ? 0 : roster.robots.size(), false);
  for (const std::uint32_t position : robots) {
    if (position >= roster.robots.size()) {
      return make_fault(ErrorCode::unknown_robot, "robots",
                        fmt::format("The session has {} robots; there is none at position {}.",
                                    roster.robots.size(), position));
    }
    const std::string& id = layout.robots[roster.robots[position]].id;
    if (roster.gone[position]) {
      return make_fault(ErrorCode::not_yours, "robots",
                        fmt::format("Robot '{}' has left and has no say any more.", id), id);
    }
    if (named[position]) {
      return make_fault(ErrorCode::bad_value, "robots",
                        fmt::format("Robot '{}' (position {}) is named twice.", id, position), id);
    }
    named[position] = true;
  }
  return std::nullopt;
}

}  // namespace ziggurat::wire
