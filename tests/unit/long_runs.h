#pragma once
// How long the longest runs of the tests are, and how large.

#include <initializer_list>
#include <vector>

namespace ziggurat::long_runs {

/// Whether clang's sanitizers make the program about twenty times as slow.
#ifndef __has_feature
constexpr bool is_slow = false;
#elif __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool is_slow = true;
#else
constexpr bool is_slow = false;
#endif

constexpr double a_minute = is_slow ? 2 : 60;  ///< simulated [s]
constexpr int links_of_a_chain = is_slow ? 5 : 20;

/// All of them, or the first alone where the program is slow.
inline std::vector<double> some_of(std::initializer_list<double> all) {
  return {all.begin(), is_slow ? all.begin() + 1 : all.end()};
}

}  // namespace ziggurat::long_runs
