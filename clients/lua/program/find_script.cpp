// SPDX-License-Identifier: MIT
#include "program/find_script.h"

#include <fstream>
#include <system_error>

namespace ziggurat::lua {
namespace {

namespace fs = std::filesystem;

bool is_readable(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) && std::ifstream(path).good();
}

}  // namespace

FoundScript find_script(const std::string& resolved,
                        const std::vector<std::pair<std::string, std::string>>& params,
                        const Nameable& nameable) {
  std::string written;
  for (const auto& [name, value] : params) {
    if (name == "script") written = value;
  }
  for (const std::string& script : {resolved, written}) {
    const bool is_named_well = nameable.any_ending || script.ends_with(".lua");
    if (is_named_well && nameable.folders.contain(script) && is_readable(script))
      return {script, {}, {}};
  }
  if (resolved.empty() && written.empty()) {
    return {{}, "the scene has no Lua script for it; set one with --script FILE", {}};
  }
  const std::string other =
      resolved.empty() || written.empty() || written == resolved ? "" : ", or '" + written + "'";
  return {{},
          (resolved.empty() ? written : resolved) + ": the server names this script" + other +
              ", and there is no such file" + (nameable.any_ending ? "" : " with the ending .lua") +
              " below the folders that ziggurat-lua may use; allow its folder with --script-folder "
              "DIR, or set another with --script FILE",
          "; it looked below " + nameable.folders.names()};
}

}  // namespace ziggurat::lua
