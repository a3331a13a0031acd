// SPDX-License-Identifier: MIT
// The loops for processors with 256-bit registers. They use AVX2 without fused multiply-add, which
// would round differently. The headers come first: only our own functions may be compiled for AVX2.
// Otherwise the linker could hand an inline function of a header to the rest of the program.
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "magnetism/kernel.h"

#if defined(__x86_64__)
#define ZIGGURAT_AVX2  // neither compiler defines __AVX2__ for its pragma
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif

namespace ziggurat::magnetism {
namespace {
#include "magnetism/kernel.inl"
}  // namespace
}  // namespace ziggurat::magnetism
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

namespace ziggurat::magnetism {

const Kernel* avx2_kernel() {
  static constexpr Kernel kernel{"avx2", pairs, all_pairs, field_at, points};
  return __builtin_cpu_supports("avx2") ? &kernel : nullptr;
}

}  // namespace ziggurat::magnetism

#else

const ziggurat::magnetism::Kernel* ziggurat::magnetism::avx2_kernel() { return nullptr; }

#endif
