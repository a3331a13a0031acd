#include "processes/commands.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>
#include <system_error>

#include "processes/places.h"
#include "scene/additions.h"
#include "scene/values.h"
#include "text/quoting.h"

namespace ziggurat::processes {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view white = " \t\r\n";

/// What /bin/sh runs itself.
constexpr std::array<std::string_view, 33> shell_words{
    "!",    ".",      ":",     "[",    "alias", "bg",    "break", "case",   "cd",
    "command", "echo", "eval",  "exec", "exit", "export", "false", "for",    "if",
    "kill", "printf", "read",  "set",  "shift", "test",  "time",  "trap",   "true",
    "type", "ulimit", "umask", "until", "wait", "while"};
constexpr std::array<std::string_view, 8> script_endings{".py", ".lua", ".js", ".rb",
                                                         ".pl", ".sh",  ".jar", ".m"};

struct Word {
  std::size_t begin = 0, size = 0;
};

/// The word at or behind a place of a command; of size 0 if it has none.
Word word_at(std::string_view command, std::size_t place) {
  const std::size_t begin = std::min(command.find_first_not_of(white, place), command.size());
  const std::size_t end = std::min(command.find_first_of(white, begin), command.size());
  return {begin, end - begin};
}

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

struct Finder {
  const std::string& command;
  const fs::path& naming_file;
  const fs::path& scene_file;

  std::string text(const Word& word) const { return command.substr(word.begin, word.size); }

  std::string replaced(const Word& word, const fs::path& by) const {
    return command.substr(0, word.begin) + text::shell_word(by.string()) +
           command.substr(word.begin + word.size);
  }

  /// The first word, or the one behind exec.
  Word program_word() const {
    const Word first = word_at(command, 0);
    return text(first) == "exec" ? word_at(command, first.begin + first.size) : first;
  }

  /// Whether only a shell can read the word, or runs it itself.
  bool is_of_shell(const Word& word) const {
    return !text::is_plain_word(text(word)) || std::ranges::find(shell_words, text(word)) != shell_words.end();
  }

  /// A sentence if no shell finds a program of this name.
  std::string missing_in_path(const std::string& name) const {
    if (is_in_path(name)) return {};
    const bool is_beside = find_file(name, naming_file, scene_file).has_value();
    return fmt::format("'{}' is no program in PATH; {}", name,
                       is_beside ? fmt::format("write ./{}, which is there", name)
                                 : "install it, or write its path");
  }

  FoundCommand program(const Word& word) const {
    const std::string name = text(word);
    const auto found = find_file(name, naming_file, scene_file);
    if (!found) {
      return {command, fmt::format("'{}' is not there{}", name,
                                   looked_for(name, naming_file, scene_file))};
    }
    if (::access(found->c_str(), X_OK) != 0) {
      return {replaced(word, *found),
              fmt::format("{0} can't be executed; write chmod +x {0}", found->string())};
    }
    return {replaced(word, *found), {}};
  }

  /// The first argument that is no option, if it is a script.
  FoundCommand script(std::size_t behind_program) const {
    Word word = word_at(command, behind_program);
    while (word.size > 0 && command[word.begin] == '-') {
      word = word_at(command, word.begin + word.size);
    }
    const std::string name = text(word);
    const auto ends_name = [&](std::string_view ending) { return name.ends_with(ending); };
    if (!text::is_plain_word(name) || std::ranges::none_of(script_endings, ends_name)) return {command, {}};
    if (const auto found = find_file(name, naming_file, scene_file)) {
      return {replaced(word, *found), {}};
    }
    return {command, fmt::format("'{}' is not there{}", name,
                                 looked_for(name, naming_file, scene_file))};
  }
};

}  // namespace

FoundCommand find_command(const std::string& command, const fs::path& naming_file,
                          const fs::path& scene_file) {
  const Finder finder{command, naming_file, scene_file};
  const Word first = finder.program_word();
  const std::string program = finder.text(first);
  if (finder.is_of_shell(first)) return {command, {}};
  if (program.find('/') != std::string::npos) return finder.program(first);
  if (std::string missing = finder.missing_in_path(program); !missing.empty()) return {command, missing};
  return finder.script(first.begin + first.size);
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
  const Finder finder{command, here, here};
  const std::string program = finder.text(finder.program_word());
  if (program.empty() || program == "''" || program == "\"\"") return "it names no program: its first word is empty";
  if (finder.is_of_shell(finder.program_word())) return {};
  if (program.find('/') == std::string::npos) return finder.missing_in_path(program);
  const fs::path file = fs::absolute(program).lexically_normal();
  std::error_code error;
  if (fs::is_regular_file(file, error)) {
    return ::access(file.c_str(), X_OK) == 0
               ? std::string()
               : fmt::format("'{0}' can't be executed; write chmod +x {0}", program);
  }
  if (fs::exists(file, error)) return fmt::format("'{}' is no program but a folder or device", program);
  const std::string meant = similar_file(file);
  return fmt::format("'{}' is not there: {} has no such file{}", program, file.parent_path().string(),
                     meant.empty() ? "; check its path" : fmt::format("; did you mean '{}'?", meant));
}

}  // namespace ziggurat::processes
