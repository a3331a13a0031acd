// SPDX-License-Identifier: MIT
#pragma once
// Options of a run, each declared once: the command line, settings files, scenes and the help are
// read and written by this table.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "run/options.h"
#include "scene/reader.h"

namespace ziggurat::run {

/// Commands that have an option, as bits.
enum Commands : unsigned {
  by_run = 1,
  by_serve = 2,
  by_fork = 4,
  by_render = 8,
  by_replay = 16,
  by_check = 32,
  by_verify = 64
};

enum class Use { common, rare };

/// Places in which an option may be written: each also in those before.
enum class Place { command_line, settings, scene };

/// For options that may be repeated: called for each value.
struct Each {
  void (*read)(Options&, const std::string&);
};
/// Reads one that its command reads itself.
struct ByCommand {
  bool is_repeated = false;
};

/// The field that an option sets, or the function that reads its text.
/// @throws text::UsageError (the functions)
using Target =
    std::variant<ByCommand, bool Options::*, std::string Options::*,
                 std::vector<std::string> Options::*, void (*)(Options&, const std::string&), Each>;

struct Option {
  const char* name;   ///< without dashes; in a scene with underscores
  const char* value;  ///< the name of its value in the help; null = a flag
  unsigned commands;  ///< of Commands
  Use use;
  Place place;
  Target target;
  const char* text;  ///< for the help
  /// Its value where none is written; null = it needs one.
  const char* implicit = nullptr;
};

bool is_flag(const Option& option);
bool is_repeated(const Option& option);

struct OptionGroup {
  const char* heading;  ///< in the help
  const char* table;    ///< of settings files
  std::span<const Option> options;
};

std::span<const OptionGroup> option_groups();

/// The option of that name, or null.
const Option* option_named(std::string_view name);

/// Sets what the option is for. @param value  empty for flags. @throws text::UsageError
void apply(const Option& option, Options& options, const std::string& value);

/// Attributes of a scene's <run>, which has underscores in the names.
scene::RunAttributes run_attributes();

/// Sets what the scene has and Options::open_to_scene names.
void apply_scene(const scene::Scene& scene, Options& options);

/// @param seconds  simulated ones that this option has
/// @throws text::UsageError if they are more than a run can have
void check_time(const char* option, double seconds);

}  // namespace ziggurat::run
