#pragma once
// Pictures of robots' cameras as PNG files, one per camera and tick.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "world/layout.h"
#include "world/state.h"

namespace ziggurat::outputs {

/// `robot.camera.000123.png`. In ids, bytes other than letters, digits, `-` or `_` become `%` and
/// two hexadecimal digits. So any two ids differ, and none leaves the folder.
std::string image_name(std::string_view robot, std::string_view camera, std::uint64_t tick);

class Images {
 public:
  /// Makes the folder if it isn't there. @param layout  has to outlive this
  /// @throws WriteError
  Images(std::string folder, const world::Layout& layout);

  /// Nothing for pictures that are empty, as those of tick 0. @throws WriteError
  void write(const world::Observations& observations);

 private:
  std::string folder_;
  const world::Layout& layout_;
};

}  // namespace ziggurat::outputs
