#pragma once
// How long the longest runs of the tests are.

namespace ziggurat::long_runs {

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define ZIGGURAT_SLOW_TESTS  // twenty times as slow
#endif
#endif

#ifdef ZIGGURAT_SLOW_TESTS
constexpr double a_minute = 2;  ///< simulated [s]
#else
constexpr double a_minute = 60;  ///< simulated [s]
#endif

}  // namespace ziggurat::long_runs
