#pragma once
// What a session commands of one kind of device.

#include <vector>

namespace ziggurat {

/// Sent whole if some of it changed. Handles point into `values`.
template <typename T>
struct Settings {
  std::vector<T> values;
  std::vector<T> initial;
  bool changed = false;  // since the last answer

  void reset() {
    values = initial;
    changed = false;
  }
};

}  // namespace ziggurat
