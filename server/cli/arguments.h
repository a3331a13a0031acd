#pragma once
// Command lines: parsed against what a command knows, with a suggestion for what it doesn't.

#include <boost/program_options/options_description.hpp>
#include <boost/program_options/variables_map.hpp>
#include <string>
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

}  // namespace ziggurat::cli
