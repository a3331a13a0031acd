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
                        const Folders& folders) {
  std::string written;
  for (const auto& [name, value] : params) {
    if (name == "script") written = value;
  }
  std::string outside;
  for (const std::string& script : {resolved, written}) {
    if (script.empty() || !is_readable(script)) continue;
    if (folders.contain(script)) return {script, {}};
    if (outside.empty()) outside = script;
  }
  if (resolved.empty() && written.empty()) {
    return {{}, "the scene has no Lua script for it; set one with --script FILE"};
  }
  if (!outside.empty()) {
    return {{},
            outside + ": the server names this script, and it is not below " + folders.names() +
                "; allow its folder with --script-folder DIR, or set another with --script FILE"};
  }
  std::error_code error;
  std::string fault = resolved.empty() ? written : resolved;
  fault += ": the script can't be read on this machine";
  if (!written.empty())
    fault += ", nor is '" + written + "' in " + fs::current_path(error).string();
  return {{}, fault + "; set another with --script FILE"};
}

}  // namespace ziggurat::lua
