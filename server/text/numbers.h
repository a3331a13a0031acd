#pragma once
// Numbers as people write them, for example on a command line.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace ziggurat::text {

/// A value that cannot be used; the message names its place and what is allowed.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The whole text as a number; `option` names the place in the UsageError otherwise thrown.
std::uint64_t to_integer(std::string_view option, const std::string& text);
double to_number(std::string_view option, const std::string& text);  ///< finite

/// How many seconds a unit of time has: us, ms or s; nothing for another word.
std::optional<double> seconds_in(std::string_view unit);

/// Bytes, with an optional K, M or G (powers of 1024) behind the number.
std::size_t to_size(std::string_view option, const std::string& text);

}  // namespace ziggurat::text
