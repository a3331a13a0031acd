// SPDX-License-Identifier: MIT
#pragma once
// The options of `run` and its kin: what a command line and a settings file ask for, and the help.

#include <boost/program_options/options_description.hpp>
#include <boost/program_options/variables_map.hpp>
#include <optional>
#include <string>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "run/options.h"
#include "run/options/option_table.h"

namespace ziggurat::cli {

enum class Detail { common, all };

/// Options of a command, in groups with headings, as its help prints them.
boost::program_options::options_description options_of(run::Commands command,
                                                       Detail detail = Detail::all);

/// The help of these; its last line counts the others.
std::string options_help(run::Commands command, std::string_view name, Detail detail);

/// The pictures and the film that are asked for; nothing: none. @throws UsageError
std::optional<run::PictureOptions> to_pictures(const boost::program_options::variables_map& values);

/// A command line and what its --settings adds.
struct GivenOptions {
  Parsed own;                                 ///< the command line alone
  boost::program_options::variables_map all;  ///< with the settings
  std::vector<std::string> switched_off;      ///< flags that the settings have as false
};
/// @throws UsageError
GivenOptions read_given(const Arguments& arguments, run::Commands command);

/// @throws UsageError
run::Options parse_options(const Arguments& arguments, run::Commands command);

}  // namespace ziggurat::cli
