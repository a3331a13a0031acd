// SPDX-License-Identifier: MIT
// The loops for any processor.
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "render/shading.h"

namespace ziggurat::render {
namespace {
#include "render/shading.inl"
}  // namespace

const Kernel& baseline_kernel() {
  static constexpr Kernel kernel{"baseline", draw, lay_floor, shade};
  return kernel;
}

}  // namespace ziggurat::render
