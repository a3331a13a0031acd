// SPDX-License-Identifier: MIT
#include "text/numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

namespace ziggurat::text {

std::uint64_t to_integer(std::string_view option, const std::string& text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    const std::string most =
        error == std::errc::result_out_of_range ? fmt::format("to {}", ~std::uint64_t{0}) : "on";
    throw UsageError(
        fmt::format("{} is '{}'; it must be a whole number from 0 {}", option, text, most));
  }
  return value;
}

double to_number(std::string_view option, const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    throw UsageError(fmt::format("{} is '{}'; it must be a finite number", option, text));
  }
  return value;
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts(1);
  for (const char character : text) {
    if (character == separator) {
      parts.emplace_back();
    } else {
      parts.back() += character;
    }
  }
  return parts;
}

void to_numbers(std::string_view option, const std::string& text, std::string_view form,
                std::span<double> places) {
  const auto parts = split(text, ',');
  if (parts.size() != places.size()) {
    throw UsageError(fmt::format("{} is '{}'; it must be {}", option, text, form));
  }
  for (std::size_t i = 0; i < places.size(); ++i) places[i] = to_number(option, parts[i]);
}

std::optional<double> seconds_in(std::string_view unit) {
  if (unit == "us") return 1e-6;
  if (unit == "ms") return 1e-3;
  if (unit == "s") return 1;
  return std::nullopt;
}

std::size_t to_size(std::string_view option, const std::string& text) {
  const auto place = text.empty() ? std::string::npos : std::string("KMG").find(text.back());
  const unsigned shift = place == std::string::npos ? 0 : 10 * (static_cast<unsigned>(place) + 1);
  const auto number = to_integer(option, shift ? text.substr(0, text.size() - 1) : text);
  if (number > (std::numeric_limits<std::size_t>::max() >> shift)) {
    throw UsageError(fmt::format("{} is '{}', which is too large", option, text));
  }
  return static_cast<std::size_t>(number) << shift;
}

std::string to_duration(double seconds) {
  const auto whole = static_cast<std::uint64_t>(std::min(std::ceil(seconds), 1e15));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
}

}  // namespace ziggurat::text
