#pragma once
// The options of `run`, `serve`, `check`, `render`, `replay` and `fork`: their help, and what they
// ask for.

#include <boost/program_options/options_description.hpp>
#include <boost/program_options/variables_map.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "run/options.h"
#include "scene/scene.h"

namespace ziggurat::cli {

/// Options of each command, in groups with headings as its help prints them.
boost::program_options::options_description run_options();
boost::program_options::options_description serve_options();
boost::program_options::options_description check_options();
boost::program_options::options_description render_options();
boost::program_options::options_description replay_options();
boost::program_options::options_description fork_options();
boost::program_options::options_description picture_options();

/// The pictures and the film that are asked for; nothing: none. @throws UsageError
std::optional<run::PictureOptions> to_pictures(const boost::program_options::variables_map& values);

/// @param seconds  simulated ones that this option has. @throws UsageError if they are more than a
/// run can have
void check_time(const char* option, double seconds);

/// @throws UsageError
run::Options parse_options(const Arguments& arguments,
                           const boost::program_options::options_description& known);

/// @param settings    of --set: `PATH=VALUE`
/// @param parameters  of --param: `NAME=VALUE`
/// @throws text::UsageError
scene::Variation to_variation(const std::vector<std::string>& settings,
                              const std::vector<std::string>& parameters);

}  // namespace ziggurat::cli
