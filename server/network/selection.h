#pragma once
// Which robots a Hello asks for.

#include <cstddef>
#include <variant>
#include <vector>

#include "wire/messages.h"

namespace ziggurat::network {

/// A robot that a Hello selects. Those named by id must be there for the taking; those that only
/// fit a pattern are passed over if they have left.
struct Selected {
  std::size_t robot = 0;  ///< into Layout::robots
  bool by_id = false;
};

/// Robots of a Hello in scene order, or the fault of its criteria.
std::variant<std::vector<Selected>, wire::Fault> select_robots(const wire::Hello& hello,
                                                               const wire::Run& run);

}  // namespace ziggurat::network
