// SPDX-License-Identifier: MIT
#pragma once
// Allocations of a test's thread, counted by an operator new that replaces that of the whole
// program.

#include <cstddef>

namespace ziggurat::testing {

/// Number of calls of operator new by this thread so far.
std::size_t allocations();

/// While it lives, one call of operator new in this thread throws std::bad_alloc.
class FailingAllocation {
 public:
  /// @param index  of that call, counted from now on: 0 is the next one
  explicit FailingAllocation(std::size_t index);
  ~FailingAllocation();
  FailingAllocation(const FailingAllocation&) = delete;
  FailingAllocation& operator=(const FailingAllocation&) = delete;
};

}  // namespace ziggurat::testing
