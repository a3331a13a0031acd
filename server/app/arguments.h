#pragma once
// Command lines: parsed against what a command knows, with a suggestion for what it doesn't.

#include <boost/program_options/options_description.hpp>
#include <boost/program_options/variables_map.hpp>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "app/commands.h"

namespace ziggurat::app {

/// A wrong command line; the message says what would be right.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Parsed {
  boost::program_options::variables_map values;
  std::vector<std::string> positional;
};

/// Options may stand anywhere, `--` ends them, abbreviations are not guessed. All values are
/// taken as text. @throws UsageError
Parsed parse(const Arguments& arguments, const boost::program_options::options_description& known);

/// The candidate that a misspelt word most likely meant; empty if none is near.
std::string closest(std::string_view word, std::span<const std::string> candidates);

/// The whole text as a number; `option` names the place in the UsageError otherwise thrown.
std::uint64_t to_integer(std::string_view option, const std::string& text);
double to_number(std::string_view option, const std::string& text);  ///< finite

/// Bytes, with an optional K, M or G (powers of 1024) behind the number.
std::size_t to_size(std::string_view option, const std::string& text);

}  // namespace ziggurat::app
