// SPDX-License-Identifier: MIT
#include "processes/commands.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <system_error>

#include "processes/command_words.h"
#include "processes/places.h"
#include "scene/additions.h"
#include "scene/values.h"
#include "text/quoting.h"

namespace ziggurat::processes {
namespace {

namespace fs = std::filesystem;

/// Commands that /bin/sh runs itself.
constexpr std::array<std::string_view, 33> shell_words{
    "!",       ".",      ":",     "[",     "alias", "bg",     "break", "case", "cd",
    "command", "echo",   "eval",  "exec",  "exit",  "export", "false", "for",  "if",
    "kill",    "printf", "read",  "set",   "shift", "test",   "time",  "trap", "true",
    "type",    "ulimit", "umask", "until", "wait",  "while"};
constexpr std::array<std::string_view, 8> script_endings{".py", ".lua", ".js",  ".rb",
                                                         ".pl", ".sh",  ".jar", ".m"};

bool is_in_path(const std::string& program) {
  const char* variable = std::getenv("PATH");
  const std::string path = variable == nullptr ? "/usr/local/bin:/usr/bin:/bin" : variable;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find(':', begin), path.size());
    const fs::path file = fs::path(path.substr(begin, end - begin)) / program;
    if (::access(file.c_str(), X_OK) == 0) return true;
    begin = end + 1;
  }
  return false;
}

constexpr std::array<std::string_view, 16> interpreters{
    "python", "pypy", "lua",  "node",  "ruby",   "perl", "bash", "sh",
    "dash",   "zsh",  "java", "julia", "octave", "deno", "php",  "Rscript"};

bool is_interpreter(const std::string& program) {
  const std::string name = fs::path(program).filename().string();
  return std::ranges::any_of(interpreters,
                             [&](std::string_view each) { return name.starts_with(each); });
}

/// Whether behind this option stands no script, but program text or a module: `-c`, `-lc`, `-m`.
bool is_for_text(const std::string& option) {
  return !option.starts_with("--") && (option.ends_with('c') || option.ends_with('m'));
}

struct Finder {
  const std::string& command;
  const fs::path& naming_file;
  const fs::path& scene_file;
  std::optional<std::string> scene_folder;  ///< none: only a shell knows it

  /// Whether only a shell can read the word, or runs it itself.
  static bool is_of_shell(const Word& word) {
    const bool is_shell_word =
        !word.is_quoted && std::ranges::find(shell_words, word.text) != shell_words.end();
    return word.size == 0 || !word.is_literal || is_shell_word;
  }

  std::string not_there(const std::string& name) const {
    return fmt::format("'{}' is not there{}", name, looked_for(name, naming_file, scene_file));
  }

  /// A sentence if no shell finds a program of this name.
  std::string missing_in_path(const std::string& name) const {
    if (is_in_path(name)) return {};
    const bool is_beside = find_file(name, naming_file, scene_file).has_value();
    return fmt::format("'{}' is no program in PATH; {}", name,
                       is_beside ? fmt::format("write ./{}, which is there", name)
                                 : "install it, or write its path");
  }

  /// The first argument that is no option, if it is a script; of size 0 if it is not.
  Word script_behind(const Word& program) const {
    Word word = word_at(command, program.end(), scene_folder);
    while (word.is_literal && word.text.starts_with('-')) {
      if (is_for_text(word.text)) return {};
      word = word_at(command, word.end(), scene_folder);
    }
    const auto ends_name = [&](std::string_view ending) { return word.text.ends_with(ending); };
    return word.is_literal && std::ranges::any_of(script_endings, ends_name) ? word : Word{};
  }

  FoundCommand find() const {
    const Word program = program_word(command, scene_folder);
    if (is_of_shell(program)) return {command, {}};
    FoundCommand found{command, {}};
    const bool has_path = program.text.find('/') != std::string::npos;
    // From the end, so that places in front stay as they are.
    if (!has_path || is_interpreter(program.text)) replace(script_behind(program), found);
    if (has_path) {
      const auto file = replace(program, found);
      if (file && ::access(file->c_str(), X_OK) != 0) {
        found.missing = fmt::format("{0} can't be executed; write chmod +x {0}", file->string());
      }
    } else if (std::string missing = missing_in_path(program.text); !missing.empty()) {
      found = {command, missing};
    }
    return found;
  }

  /// Puts the file that the word names in its place.
  std::optional<fs::path> replace(const Word& word, FoundCommand& found) const {
    if (word.size == 0) return std::nullopt;
    const auto file = find_file(word.text, naming_file, scene_file);
    if (file) {
      found.text.replace(word.begin, word.size, text::shell_word(file->string()));
    } else {
      found.missing = not_there(word.text);
    }
    return file;
  }
};

}  // namespace

FoundCommand find_command(const std::string& command, const fs::path& naming_file,
                          const fs::path& scene_file) {
  return Finder{command, naming_file, scene_file, scene_folder(scene_file)}.find();
}

std::string scene_folder(const fs::path& scene_file) {
  return fs::absolute(scene_file).lexically_normal().parent_path().string();
}

std::vector<scene::Problem> find_commands(scene::Scene& scene, const fs::path& scene_file) {
  std::vector<scene::Problem> problems;
  const auto find = [&](auto& starter, const std::string& element) {
    if (starter.command.empty()) return;
    const std::string file = scene::file_of(scene, starter.where);
    FoundCommand found = find_command(starter.command, file, scene_file);
    if (!found.missing.empty()) {
      problems.push_back({scene::Problem::Severity::warning, file, starter.where,
                          fmt::format("command={} of <{}>: {}", scene::in_quotes(starter.command),
                                      element, found.missing)});
    }
    starter.command = std::move(found.text);
  };
  for (scene::Controller& controller : scene.controllers) find(controller, controller.type);
  for (scene::Director& director : scene.directors) find(director, "director");
  return problems;
}

std::string why_not_started(const std::string& command) {
  const fs::path here = fs::current_path() / "-";
  const Finder finder{command, here, here, std::nullopt};
  const Word word = program_word(command, std::nullopt);
  const std::string& program = word.text;
  if (word.is_literal && program.empty()) return "it names no program: its first word is empty";
  if (Finder::is_of_shell(word)) return {};
  if (program.find('/') == std::string::npos) return finder.missing_in_path(program);
  const fs::path file = fs::absolute(program).lexically_normal();
  std::error_code error;
  if (fs::is_regular_file(file, error)) {
    return ::access(file.c_str(), X_OK) == 0
               ? std::string()
               : fmt::format("'{0}' can't be executed; write chmod +x {0}", program);
  }
  if (fs::exists(file, error))
    return fmt::format("'{}' is no program but a folder or device", program);
  const std::string meant = similar_file(file);
  return fmt::format(
      "'{}' is not there: {} has no such file{}", program, file.parent_path().string(),
      meant.empty() ? "; check its path" : fmt::format("; did you mean '{}'?", meant));
}

}  // namespace ziggurat::processes
