// SPDX-License-Identifier: MIT
#pragma once
// Parses command lines, with a suggestion for a misspelt option.

#include <boost/program_options/options_description.hpp>
#include <boost/program_options/variables_map.hpp>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/commands.h"

namespace ziggurat::cli {

struct Parsed {
  boost::program_options::variables_map values;
  std::vector<std::string> positional;
};

/// The values of a parsed command line, by the names of the options.
class Values {
 public:
  explicit Values(const boost::program_options::variables_map& values) : values_(values) {}

  bool has(const char* name) const { return values_.count(name) > 0; }
  /// Empty without the option.
  std::string text(const char* name) const {
    return has(name) ? values_[name].as<std::string>() : std::string();
  }
  std::vector<std::string> texts(const char* name) const {
    return has(name) ? values_[name].as<std::vector<std::string>>() : std::vector<std::string>();
  }

 private:
  const boost::program_options::variables_map& values_;
};

/// Options may stand anywhere, `--` ends them, abbreviations are not guessed. All values are
/// taken as text. @throws text::UsageError
Parsed parse(const Arguments& arguments, const boost::program_options::options_description& known);

/// Refuses options that have no effect without another one. @throws text::UsageError
void check_needs(const Values& values, std::initializer_list<const char*> options,
                 const char* other);
/// Refuses options that have no effect beside another one. @throws text::UsageError
void check_apart(const Values& values, const char* other,
                 std::initializer_list<const char*> options);

/// The names of NAME=VALUE.
std::vector<std::string> first_of(const std::vector<std::pair<std::string, std::string>>& pairs);

/// Refuses an option that is given twice for the same: one of its values would have no effect.
/// @param subjects  what each is for; empty: for all. @throws text::UsageError
void check_once(const char* option, std::vector<std::string> subjects);

/// The one recording that a command is for. @throws text::UsageError if there is none or more
const std::string& only_recording(std::string_view command,
                                  const std::vector<std::string>& positional);

}  // namespace ziggurat::cli
