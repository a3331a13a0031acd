// SPDX-License-Identifier: MIT
#include "outputs/output_name.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <string_view>

#include "text/numbers.h"

namespace ziggurat::outputs {
namespace {

namespace fs = std::filesystem;

/// Files that are worth more than an output.
struct Kind {
  std::string_view name;  ///< in a message
  std::string_view ending;
};
constexpr std::array kinds{Kind{"a scene", ".argos"},      Kind{"a Lua script", ".lua"},
                           Kind{"a recording", ".mcap"},   Kind{"a database", ".sqlite"},
                           Kind{"an experiment", ".toml"}, Kind{"a secret key", ".secret"}};

/// Names of what the shell has opened.
bool is_open_stream(const std::string& path) {
  return path.starts_with("/dev/std") || path.starts_with("/dev/fd/") ||
         path.starts_with("/proc/self/fd/");
}

/// A pipe or a device, too.
bool is_stream(const std::string& path) {
  std::error_code error;
  return path == "-" || is_open_stream(path) ||
         (fs::exists(path, error) && !fs::is_regular_file(path, error));
}

void check_ending(const OutputName& output) {
  if (output.endings.empty() || is_stream(output.path)) return;
  const auto fits = [&](const std::string& ending) { return output.path.ends_with(ending); };
  if (std::ranges::any_of(output.endings, fits)) return;
  throw text::UsageError(
      fmt::format("{} is '{}'; its name must end with {}, because that is the "
                  "format of its content",
                  output.option, output.path, fmt::join(output.endings, " or ")));
}

/// Null: of none, or there is no file.
const Kind* kind_of(const std::string& path) {
  std::error_code error;
  if (is_open_stream(path) || !fs::is_regular_file(path, error)) return nullptr;
  const std::string target = fs::canonical(path, error).string();
  const auto found =
      std::ranges::find_if(kinds, [&](const Kind& kind) { return target.ends_with(kind.ending); });
  return found == std::end(kinds) ? nullptr : &*found;
}

}  // namespace

bool is_one_file(const std::string& a, const std::string& b) {
  std::error_code error;
  if (fs::exists(a, error) && !fs::is_regular_file(a, error)) return false;
  if (fs::equivalent(a, b, error)) return true;
  return fs::weakly_canonical(fs::absolute(a), error) ==
             fs::weakly_canonical(fs::absolute(b), error) &&
         !error;
}

void check_output(const OutputName& output, std::span<const TakenFile> taken) {
  check_ending(output);
  for (const TakenFile& file : taken) {
    if (!is_one_file(output.path, file.path)) continue;
    throw text::UsageError(
        fmt::format("{} is '{}', {}; name another file", output.option, output.path, file.what));
  }
  const Kind* kind = kind_of(output.path);
  if (!kind || std::ranges::find(output.endings, kind->ending) != output.endings.end()) return;
  throw text::UsageError(fmt::format("{} is '{}', {}, which it would replace; name another file",
                                     output.option, output.path, kind->name));
}

}  // namespace ziggurat::outputs
