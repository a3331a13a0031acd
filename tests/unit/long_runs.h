// SPDX-License-Identifier: MIT
#pragma once
// Share of the longest tests that runs: a part of the rates and seeds in the normal run, all with
// ZIGGURAT_TEST_ALL=1.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>
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

/// Whether all rates and seeds run: ZIGGURAT_TEST_ALL=1 in the environment.
inline bool takes_all() {
  static const char* const value = std::getenv("ZIGGURAT_TEST_ALL");
  return value != nullptr && std::string_view(value) == "1";
}

/// A number of all runs, of those of the normal run, or one where the program is slow.
inline unsigned runs(unsigned all, unsigned normal) {
  if (is_slow) return 1;
  return takes_all() ? all : normal;
}

constexpr double a_minute = is_slow ? 2 : 60;  ///< simulated [s]
constexpr int links_of_a_chain = is_slow ? 5 : 20;

/// All values, mostly rates. The normal run takes the first, which a fault was found at, and 50 and
/// 1 000; in place of one that is not among them the least and the greatest. Where the program is
/// slow, the first alone.
inline std::vector<double> some_of(const std::vector<double>& all) {
  if (is_slow) return {all.front()};
  if (takes_all()) return all;
  const auto or_else = [&](double wanted, double other) {
    return std::ranges::find(all, wanted) != all.end() ? wanted : other;
  };
  std::vector<double> out{all.front()};
  for (const double next :
       {or_else(50, std::ranges::min(all)), or_else(1000, std::ranges::max(all))}) {
    if (std::ranges::find(out, next) == out.end()) out.push_back(next);
  }
  return out;
}

/// The first alone in the normal run: what a longer one adds takes much and rarely breaks.
inline std::vector<double> first_of(const std::vector<double>& all) {
  if (takes_all() && !is_slow) return all;
  return {all.front()};
}

/// Which substep rates a test is for [Hz].
struct Range {
  double least = 50, most = 2000;
  double first = 0;  ///< rate that a fault was found at; 0: the least
};

/// Substep rates of 50 to 2 000 Hz, as some_of takes them [Hz].
inline std::vector<double> substep_rates(const Range& range = {}) {
  std::vector<double> all;
  if (range.first > 0) all.push_back(range.first);
  for (const double hz : {50, 100, 200, 500, 1000, 2000}) {
    if (hz >= range.least && hz <= range.most && hz != range.first) all.push_back(hz);
  }
  return some_of(all);
}

/// Names a case of a parameterised suite by its rate, as "50Hz".
template <class Parameter>
std::string name_of_rate(const Parameter& rate) {
  return std::to_string(std::lround(rate.param)) + "Hz";
}

}  // namespace ziggurat::long_runs
