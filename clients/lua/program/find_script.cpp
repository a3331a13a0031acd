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
                        const std::vector<std::pair<std::string, std::string>>& params) {
  if (!resolved.empty() && is_readable(resolved)) return {resolved, {}};
  std::string written;
  for (const auto& [name, value] : params) {
    if (name == "script") written = value;
  }
  if (!written.empty() && is_readable(written)) return {written, {}};
  if (resolved.empty() && written.empty()) {
    return {{}, "the scene has no Lua script for it; set one with --script FILE"};
  }
  std::error_code error;
  std::string fault = resolved.empty() ? written : resolved;
  fault += ": the script can't be read on this machine";
  if (!written.empty())
    fault += ", nor is '" + written + "' in " + fs::current_path(error).string();
  return {{}, fault + "; set another with --script FILE"};
}

}  // namespace ziggurat::lua
