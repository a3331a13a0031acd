#pragma once
// Parses command lines, with a suggestion for a misspelt option.

#include <boost/program_options/options_description.hpp>
#include <boost/program_options/variables_map.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "cli/commands.h"

namespace ziggurat::cli {

struct Parsed {
  boost::program_options::variables_map values;
  std::vector<std::string> positional;
};

/// Options may stand anywhere, `--` ends them, abbreviations are not guessed. All values are
/// taken as text. @throws text::UsageError
Parsed parse(const Arguments& arguments, const boost::program_options::options_description& known);

/// The one recording that a command is for. @throws text::UsageError if there is none or more
const std::string& only_recording(std::string_view command,
                                  const std::vector<std::string>& positional);

}  // namespace ziggurat::cli
