// SPDX-License-Identifier: MIT
#pragma once
// Options in a file, in TOML: `lua-memory = 512`, in tables with the names of their groups or above
// them.

#include <string>
#include <vector>

#include "run/options/option_table.h"

namespace ziggurat::cli {

struct FileSetting {
  const run::Option* option;
  std::vector<std::string> values;  ///< each is right by itself; none: a flag that is false
};

/// In any order. @throws text::UsageError with file and line
std::vector<FileSetting> read_settings_file(const std::string& path);

}  // namespace ziggurat::cli
