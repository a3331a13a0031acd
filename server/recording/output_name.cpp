#include "recording/output_name.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>

#include "recording/output_file.h"
#include "text/numbers.h"

namespace ziggurat::recording {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_head = 16384;  // [bytes]; the comment of a licence before a scene fits

/// Files that are worth more than an output.
struct Kind {
  std::string_view name;    ///< in a message
  std::string_view ending;
  std::string_view begin;   ///< of its content; empty: nothing tells it
};
constexpr std::array kinds{Kind{"a scene", ".argos", "<argos-configuration"},
                           Kind{"a Lua script", ".lua", {}},
                           Kind{"a recording", ".mcap", "\x89MCAP0"},
                           Kind{"a database", ".sqlite", "SQLite format 3"},
                           Kind{"an experiment", ".toml", {}},
                           Kind{"a secret key", ".secret", {}}};

/// Names of what the shell has opened.
bool is_open_stream(const std::string& path) {
  return path.starts_with("/dev/std") || path.starts_with("/dev/fd/") || path.starts_with("/proc/self/fd/");
}

/// A pipe or a device, too.
bool is_stream(const std::string& path) {
  std::error_code error;
  return path == "-" || is_open_stream(path) || (fs::exists(path, error) && !fs::is_regular_file(path, error));
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

/// The place of a file, also where links lead to one that is not there yet.
fs::path place_of(const std::string& name, std::error_code& error) {
  constexpr int most_links = 40;  // as the system follows
  fs::path path = fs::absolute(name);
  for (int i = 0; i < most_links && fs::is_symlink(path, error); ++i) {
    path = path.parent_path() / fs::read_symlink(path, error);
  }
  return fs::weakly_canonical(path, error);
}

std::string head_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string head(longest_head, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head;
}

/// Text behind the mark of UTF-8, the declaration and the comments of XML.
std::string_view without_prologue(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  for (;;) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
    const std::string_view end = text.starts_with("<?") ? "?>" : text.starts_with("<!--") ? "-->" : "";
    const auto found = end.empty() ? text.npos : text.find(end);
    if (found == text.npos) return text;
    text.remove_prefix(found + end.size());
  }
}

/// Null: of none, or there is no file.
const Kind* kind_of(const std::string& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return nullptr;
  const std::string head = head_of(path);
  const std::string_view content = without_prologue(head);
  for (const Kind& kind : kinds) {
    if (!kind.begin.empty() && content.starts_with(kind.begin)) return &kind;
  }
  if (is_open_stream(path)) return nullptr;
  const std::string target = fs::canonical(path, error).string();
  const auto found = std::ranges::find_if(kinds, [&](const Kind& kind) { return target.ends_with(kind.ending); });
  return found == std::end(kinds) ? nullptr : &*found;
}

}  // namespace

bool is_one_file(const std::string& a, const std::string& b) {
  std::error_code error;
  if (fs::exists(a, error) && !fs::is_regular_file(a, error)) return false;
  if (fs::equivalent(a, b, error)) return true;
  const fs::path whole = place_of(a, error);
  return !error && whole == place_of(b, error) && !error;
}

void check_output(const OutputName& output, std::span<const TakenFile> taken) {
  check_ending(output);
  if (const auto planted = output.path == "-" ? std::nullopt : planted_at(output.path)) {
    throw text::UsageError(
        fmt::format("{} is '{}', {}; name another file", output.option, output.path, *planted));
  }
  for (const TakenFile& file : taken) {
    if (!is_one_file(output.path, file.path)) continue;
    throw text::UsageError(
        fmt::format("{} is '{}', {}; name another file", output.option, output.path, file.what));
  }
  const Kind* kind = output.path == "-" ? nullptr : kind_of(output.path);
  if (!kind || std::ranges::find(output.endings, kind->ending) != output.endings.end()) return;
  throw text::UsageError(fmt::format("{} is '{}', {}, which it would replace; name another file",
                                     output.option, output.path, kind->name));
}

void check_output_folder(const std::string& option, const std::string& path) {
  const auto planted = planted_at(path + "/.");  // a folder of another user may be that of a group
  if (planted) throw text::UsageError(fmt::format("{} is '{}', {}; name another folder", option, path, *planted));
}

}  // namespace ziggurat::recording
