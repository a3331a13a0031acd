// SPDX-License-Identifier: MIT
#include "reports/statistics.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ziggurat::reports {

using network::Reaction;

namespace {

constexpr std::size_t worst_shown = 5;

double nth(const std::vector<double>& ascending, double share) {
  const double place = std::ceil(share * static_cast<double>(ascending.size())) - 1;
  return ascending[static_cast<std::size_t>(std::max(place, 0.0))];
}

void count_kinds(std::span<const Reaction> reactions, Statistics& result) {
  for (const Reaction& one : reactions) {
    ++(one.kind == Reaction::Kind::in_time ? result.in_time
       : one.kind == Reaction::Kind::late  ? result.late
                                           : result.unanswered);
    ++result.histogram[bins::of(one.seconds)];
  }
}

/// Ticks, those among them that were missed, and the longest run of these.
void count_ticks(std::span<const Reaction> reactions, Statistics& result) {
  const Reaction* before = nullptr;  // of the tick before
  std::uint64_t run = 0;
  for (std::size_t i = 0; i < reactions.size();) {
    const Reaction& first = reactions[i];
    bool is_missed = false;
    for (; i < reactions.size() && reactions[i].tick == first.tick &&
           reactions[i].world == first.world;
         ++i) {
      is_missed = is_missed || reactions[i].kind != Reaction::Kind::in_time;
    }
    const bool follows =
        before != nullptr && before->world == first.world && before->tick + 1 == first.tick;
    run = is_missed ? (follows ? run : 0) + 1 : 0;
    ++result.ticks;
    result.misses += is_missed ? 1 : 0;
    result.longest_run = std::max(result.longest_run, run);
    before = &first;
  }
}

/// Mean of |change| between reactions of the same robot at ticks in a row.
double jitter_of(std::span<const Reaction> reactions) {
  std::map<std::uint32_t, const Reaction*> last;  // by robot
  double sum = 0;
  std::uint64_t changes = 0;
  for (const Reaction& one : reactions) {
    const Reaction*& before = last[one.robot];
    const bool follows =
        before != nullptr && before->world == one.world && before->tick + 1 == one.tick;
    if (follows) {
      sum += std::abs(one.seconds - before->seconds);
      ++changes;
    }
    before = &one;
  }
  return changes == 0 ? 0 : sum / static_cast<double>(changes);
}

}  // namespace

std::size_t bins::of(double seconds) {
  if (!(seconds > least)) return 0;
  const double bin = std::log10(seconds / least) * 20;
  return std::min(static_cast<std::size_t>(bin), count - 1);
}

double bins::begin_of(std::size_t bin) {
  return least * std::pow(10.0, static_cast<double>(bin) / 20);
}

Percentiles percentiles(std::vector<double>& values) {
  if (values.empty()) return {};
  std::ranges::sort(values);
  return {nth(values, 0.5), nth(values, 0.9), nth(values, 0.99), nth(values, 0.999), values.back()};
}

Statistics measure(std::span<const Reaction> reactions) {
  Statistics result;
  std::vector<double> times;
  times.reserve(reactions.size());
  for (const Reaction& one : reactions) times.push_back(one.seconds);
  result.wall_s = percentiles(times);
  count_kinds(reactions, result);
  count_ticks(reactions, result);
  result.jitter_s = jitter_of(reactions);
  result.worst.resize(std::min(worst_shown, reactions.size()));
  std::ranges::partial_sort_copy(reactions, result.worst, [](const Reaction& a, const Reaction& b) {
    return a.seconds > b.seconds;
  });
  return result;
}

}  // namespace ziggurat::reports
