#pragma once

#include <stdexcept>

namespace ziggurat::replay {

/// A recording that cannot be read or repeated: a sentence that says what is wrong, and where.
class RecordingError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace ziggurat::replay
