// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "reports/console.h"
#include "run/files.h"
#include "text/numbers.h"

namespace ziggurat::cli {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;

constexpr const char* languages[] = {"lua", "python", "cpp"};  // folders of templates

po::options_description new_options() {
  po::options_description options("Options", 96);
  options.add_options()("lua", "its controller is a Lua script (the default)")(
      "python", "its controller is a Python program")("cpp", "its controller is a C++ program");
  return options;
}

std::string language_of(const Values& values) {
  std::string chosen;
  for (const char* language : languages) {
    if (!values.has(language)) continue;
    if (!chosen.empty()) {
      throw text::UsageError(
          fmt::format("--{} and --{} are two languages; write one of them", chosen, language));
    }
    chosen = language;
  }
  return chosen.empty() ? languages[0] : chosen;
}

/// The last part of a folder's path, which becomes the name of a project.
std::string name_of(const fs::path& folder) {
  const std::string name = folder.filename().string();
  const auto is_plain = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; };
  if (!name.empty() && name[0] != '-' && std::ranges::all_of(name, is_plain)) return name;
  throw text::UsageError(fmt::format(
      "'{}' is no name; write one of letters, digits, - and _, as in: ziggurat new explorer",
      folder.string()));
}

std::string with_name(std::string text, const std::string& name) {
  constexpr std::string_view mark = "@NAME@";
  for (auto at = text.find(mark); at != text.npos; at = text.find(mark, at + name.size()))
    text.replace(at, mark.size(), name);
  return text;
}

/// Copies the files of a template, with the name in place of @NAME@. @throws text::UsageError
void copy_template(const fs::path& from, const fs::path& folder, const std::string& name) {
  if (!fs::is_directory(from)) {
    throw text::UsageError(
        fmt::format("there is no {}: the installation is not whole", from.string()));
  }
  for (const auto& file : fs::directory_iterator(from)) {
    std::ostringstream text;
    text << std::ifstream(file.path()).rdbuf();
    const fs::path to = folder / file.path().filename();
    std::ofstream out(to);
    out << with_name(text.str(), name);
    out.close();
    if (!out) throw text::UsageError(fmt::format("{} can't be written", to.string()));
    fs::permissions(to, fs::status(file).permissions() | fs::perms::owner_write);
  }
}

}  // namespace

std::string help_new() {
  return fmt::format(R"(usage: ziggurat new NAME [OPTION]

Makes the folder NAME with a scene, a controller, a test and a README.md that tells how to run them. The
folder must not exist.

  ziggurat new explorer && cd explorer && ziggurat run scene.argos
  ziggurat new explorer --python
  ziggurat new explorer --cpp

{})",
                     fmt::streamed(new_options()));
}

int execute_new(const Arguments& arguments) {
  const Parsed parsed = parse(arguments, new_options());
  const std::string language = language_of(Values(parsed.values));
  if (parsed.positional.size() != 1)
    throw text::UsageError("one name is expected; write: ziggurat new NAME [--lua|--python|--cpp]");
  const fs::path folder = parsed.positional[0];
  const std::string name = name_of(folder);
  std::error_code error;
  if (!fs::create_directory(folder, error)) {
    throw text::UsageError(fmt::format("{}: {}", folder.string(),
                                       error ? error.message() : "it exists; write another name"));
  }
  const fs::path templates = run::shared_folder("templates");
  copy_template(templates / "common", folder, name);
  copy_template(templates / language, folder, name);
  reports::Console console;
  console.result(fmt::format(
      "{}: scene.argos, its controller, test and README.md\n\n  cd {}{}\n  "
      "ziggurat run scene.argos",
      name, folder.string(), language == "cpp" ? "\n  cmake -B build && cmake --build build" : ""));
  console.flush();
  return reports::exit_code::finished;
}

}  // namespace ziggurat::cli
