// The loops for processors with 256-bit registers. AVX2 without fused multiply-add, which would
// round differently. The headers come first: only our own functions may be compiled for AVX2, or
// the linker could hand an inline function of a header to the rest of the program.
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "magnetism/kernel.h"
#include "magnetism/kernel_avx2.h"

#if defined(__x86_64__)
#pragma GCC push_options
#define ZIGGURAT_AVX2  // GCC 12 does not define __AVX2__ for the pragma
#pragma GCC target("avx2")

namespace ziggurat::magnetism {
namespace {
#include "magnetism/kernel.inl"
}  // namespace
}  // namespace ziggurat::magnetism
#pragma GCC pop_options

namespace ziggurat::magnetism {

const Kernel* avx2_kernel() {
  static constexpr Kernel kernel{"avx2", pairs, all_pairs, field_at, points};
  return __builtin_cpu_supports("avx2") ? &kernel : nullptr;
}

}  // namespace ziggurat::magnetism

#else

const ziggurat::magnetism::Kernel* ziggurat::magnetism::avx2_kernel() { return nullptr; }

#endif
