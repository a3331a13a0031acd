// SPDX-License-Identifier: MIT
// The loops for processors with 256-bit registers, as in magnetism/kernel_avx2.cpp: without fused
// multiply-add, which would round differently, and with the headers first, so that only our own
// functions are compiled for AVX2.
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "render/shading.h"

#if defined(__x86_64__)
#define ZIGGURAT_AVX2  // neither compiler defines __AVX2__ for its pragma
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif

namespace ziggurat::render {
namespace {
#include "render/shading.inl"
}  // namespace
}  // namespace ziggurat::render
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

namespace ziggurat::render {

const Kernel* avx2_kernel() {
  static constexpr Kernel kernel{"avx2", draw, lay_floor, shade};
  return __builtin_cpu_supports("avx2") ? &kernel : nullptr;
}

}  // namespace ziggurat::render

#else

const ziggurat::render::Kernel* ziggurat::render::avx2_kernel() { return nullptr; }

#endif
