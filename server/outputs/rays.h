// SPDX-License-Identifier: MIT
#pragma once
// Rays that sensors tested, and links between devices: `--rays`.

#include <string>

#include "outputs/output_file.h"
#include "world/layout.h"
#include "world/state.h"

namespace ziggurat::v1 {
class RayLine;
}

namespace ziggurat::outputs {

/// One line per ray, link or frustum of a tick: ziggurat.v1.RayLine as protobuf JSON. Only devices
/// that ask for it (`show_rays`, `show_frustum`) have any.
class Rays {
 public:
  /// Keeps a reference to `layout`. @throws WriteError
  Rays(std::string path, const world::Layout& layout);

  /// @throws WriteError
  void write(const world::State& state);
  void flush() { file_.flush(); }  ///< @throws WriteError
  void close() { file_.close(); }

 private:
  void write(const v1::RayLine& line);

  const world::Layout& layout_;
  OutputFile file_;
};

}  // namespace ziggurat::outputs
