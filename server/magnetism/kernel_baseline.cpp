// SPDX-License-Identifier: MIT
// The loops for any processor.
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "magnetism/kernel.h"

namespace ziggurat::magnetism {
namespace {
#include "magnetism/kernel.inl"
}  // namespace

const Kernel& baseline_kernel() {
  static constexpr Kernel kernel{"baseline", pairs, all_pairs, field_at, points};
  return kernel;
}

}  // namespace ziggurat::magnetism
