// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <thread>

namespace ziggurat {

/// Longest wait for an event: only a hang takes longer, on a busy machine too.
constexpr std::chrono::seconds hang{60};

/// Waits until the condition is true.
/// @return whether it is
template <class Condition>
bool comes_true(Condition condition) {
  const auto end = std::chrono::steady_clock::now() + hang;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

}  // namespace ziggurat
