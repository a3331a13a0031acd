// SPDX-License-Identifier: MIT
#include "sweep/experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <set>
#include <utility>
#include <variant>

#include "scene/settings.h"
#include "text/numbers.h"

namespace ziggurat::sweep {
namespace {

constexpr std::size_t most_runs = 10'000'000;
constexpr std::uint64_t largest_seed = std::numeric_limits<std::int64_t>::max();  // of SQLite

const char* option_of(Axis::Kind kind) {
  return kind == Axis::Kind::parameter ? "--param" : "--axis";
}

std::vector<std::string> split_at_bars(std::string_view text) {
  std::vector<std::string> parts(1);
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text.substr(i, 2) == "\\|") {
      parts.back() += text[++i];
    } else if (text[i] == '|') {
      parts.emplace_back();
    } else {
      parts.back() += text[i];
    }
  }
  for (std::string& part : parts) part = std::string(text::trimmed(part));
  return parts;
}

/// The value, or why there is none.
template <class T>
T value_of(scene::Value<T> read, const char* option, std::string_view text) {
  if (const auto* wrong = std::get_if<scene::Wrong>(&read)) {
    throw text::UsageError(fmt::format("{} {} {}", option, scene::in_quotes(text), wrong->text));
  }
  return std::get<0>(std::move(read));
}

/// As the C library reads a whole text.
std::optional<double> to_number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return end == text.c_str() || *end != '\0' ? std::nullopt : std::optional(value);
}

/// Among numbers, or alone, "nan" and "inf" are meant as numbers, and none that a scene can have.
void check_numbers(const Axis& axis) {
  for (const std::string& value : axis.values) {
    if (!to_number(value)) return;
  }
  for (const std::string& value : axis.values) {
    if (std::isfinite(*to_number(value))) continue;
    throw text::UsageError(fmt::format("{} has the value {}, which is no finite number; write one",
                                       scene::in_quotes(axis.name), scene::in_quotes(value)));
  }
}

void check_axis(const Axis& axis) {
  check_numbers(axis);
  std::set<std::string_view> seen;
  for (const std::string& value : axis.values) {
    if (seen.insert(value).second) continue;
    throw text::UsageError(fmt::format("{} has the value {} twice; write it once",
                                       scene::in_quotes(axis.name), scene::in_quotes(value)));
  }
  if (axis.values.empty()) {
    throw text::UsageError(
        fmt::format("{} has no values; write one or more", scene::in_quotes(axis.name)));
  }
}

void check_seeds(const std::vector<std::uint64_t>& seeds) {
  std::set<std::uint64_t> seen;
  for (const std::uint64_t seed : seeds) {
    if (seed == 0) {
      throw text::UsageError(
          "a seed is 0, which draws another one for each run; write seeds from 1 on: --seeds "
          "1..10");
    }
    if (seed > largest_seed) {
      throw text::UsageError(fmt::format("the seed {} is too large; {} is the largest of a sweep",
                                         seed, largest_seed));
    }
    if (!seen.insert(seed).second) {
      throw text::UsageError(fmt::format("the seed {} is there twice; write it once", seed));
    }
  }
}

}  // namespace

std::size_t run_count(const Experiment& experiment) {
  double product = static_cast<double>(experiment.seeds.size());
  std::size_t count = experiment.seeds.size();
  for (const Axis& axis : experiment.axes) {
    product *= static_cast<double>(axis.values.size());
    count *= axis.values.size();
  }
  return product <= static_cast<double>(most_runs) ? count : most_runs + 1;
}

Combination combination(const Experiment& experiment, std::size_t run) {
  Combination result;
  result.run = run;
  std::size_t rest = run - 1;
  result.seed = experiment.seeds[rest % experiment.seeds.size()];
  rest /= experiment.seeds.size();
  for (auto axis = experiment.axes.rbegin(); axis != experiment.axes.rend(); ++axis) {
    result.values.push_back(axis->values[rest % axis->values.size()]);
    rest /= axis->values.size();
  }
  std::ranges::reverse(result.values);
  return result;
}

Axis to_axis(Axis::Kind kind, std::string_view text) {
  const char* option = option_of(kind);
  Axis axis;
  axis.kind = kind;
  std::string values;
  if (kind == Axis::Kind::parameter) {
    std::tie(axis.name, values) = value_of(scene::to_parameter(text), option, text);
  } else {
    auto setting = value_of(scene::to_setting(text), option, text);
    axis.name = std::move(setting.path);
    values = std::move(setting.value);
  }
  axis.values = split_at_bars(values);
  return axis;
}

std::vector<std::uint64_t> to_seeds(std::string_view place, std::string_view text) {
  std::vector<std::uint64_t> seeds;
  while (true) {
    const std::size_t comma = text.find(',');
    const std::string_view part = text::trimmed(text.substr(0, comma));
    const std::size_t dots = part.find("..");
    const auto number = [&](std::string_view digits) {
      return text::to_integer(place, std::string(text::trimmed(digits)));
    };
    if (part.empty() || part.starts_with("..") || part.ends_with("..")) {
      throw text::UsageError(
          fmt::format("{} is '{}'; write for example 1..30 or 1,2,5..9", place, text));
    }
    if (const std::size_t dash = part.find('-'); dash != 0 && dash != part.npos) {
      throw text::UsageError(fmt::format("{} is '{}'; write {}..{}", place, part,
                                         text::trimmed(part.substr(0, dash)),
                                         text::trimmed(part.substr(dash + 1))));
    }
    const std::uint64_t first = number(part.substr(0, dots));
    const std::uint64_t last = dots == part.npos ? first : number(part.substr(dots + 2));
    if (last < first) {
      throw text::UsageError(fmt::format("{} is '{}', which ends before it begins; write {}..{}",
                                         place, part, last, first));
    }
    if (last - first >= most_runs || seeds.size() + (last - first) >= most_runs) {
      throw text::UsageError(
          fmt::format("{} is '{}'; a sweep has {} runs at most", place, part, most_runs));
    }
    for (std::uint64_t seed = first; seed <= last; ++seed) {
      seeds.push_back(seed);
      if (seed == std::numeric_limits<std::uint64_t>::max()) break;
    }
    if (comma == text.npos) return seeds;
    text.remove_prefix(comma + 1);
  }
}

void check(const Experiment& experiment) {
  std::set<std::string_view> names;
  for (const Axis& axis : experiment.axes) {
    if (!names.insert(axis.name).second) {
      throw text::UsageError(
          fmt::format("{} is given twice; write all its values once, as in "
                      "'{}=1|2'",
                      scene::in_quotes(axis.name), axis.name));
    }
    check_axis(axis);
  }
  if (run_count(experiment) > most_runs) {
    throw text::UsageError(
        fmt::format("these are more than {} runs; write fewer values or seeds", most_runs));
  }
  check_seeds(experiment.seeds);
}

}  // namespace ziggurat::sweep
