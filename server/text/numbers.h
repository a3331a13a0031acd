// SPDX-License-Identifier: MIT
#pragma once
// Numbers as people write them, for example on a command line, and durations as they read them.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace ziggurat::text {

/// A value that cannot be used; the message names its place and what is allowed.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The whole text as a number; `option` names the place in the UsageError otherwise thrown.
std::uint64_t to_integer(std::string_view option, const std::string& text);
double to_number(std::string_view option, const std::string& text);  ///< finite

/// The parts of a text between separators: one more than there are separators.
std::vector<std::string> split(std::string_view text, char separator);

/// As many numbers with commas between them as there are places, and no more.
/// @param form  what must be written, such as "x,y,z in metres, as 1,-1,0.5"
void to_numbers(std::string_view option, const std::string& text, std::string_view form,
                std::span<double> places);

/// Length of a unit of time: us, ms or s [s]; nothing for another word.
std::optional<double> seconds_in(std::string_view unit);

/// Bytes, with an optional K, M or G (powers of 1024) behind the number.
std::size_t to_size(std::string_view option, const std::string& text);

/// A time that is left, rounded up: `45 s`, `3 min 20 s` or `2 h 5 min`.
/// @param seconds  0 or more
std::string to_duration(double seconds);

}  // namespace ziggurat::text
