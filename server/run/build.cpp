// SPDX-License-Identifier: MIT
#include "run/build.h"

#include <gnu/libc-version.h>

namespace ziggurat::run {
namespace {

#ifdef __clang__
constexpr const char* compiler = "clang " __clang_version__;
#else
constexpr const char* compiler = "gcc " __VERSION__;
#endif

/// Code for wider instruction sets gives the same bits (magnetism/kernel.h); if it once does not,
/// this is where to look.
const char* cpu_path() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") ? "avx2" : "baseline";
#else
  return "baseline";
#endif
}

}  // namespace

recorder::Build this_build() {
  return {version, compiler, ZIGGURAT_BUILD_OPTIONS, gnu_get_libc_version(), cpu_path()};
}

}  // namespace ziggurat::run
