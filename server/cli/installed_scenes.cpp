// SPDX-License-Identifier: MIT
#include "cli/installed_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <system_error>

#include "run/files.h"
#include "text/names.h"
#include "text/numbers.h"

namespace ziggurat::cli {
namespace {

namespace fs = std::filesystem;

/// In a build it is a link to the checkout's.
fs::path scenes_folder() {
  std::error_code error;
  return fs::canonical(run::shared_folder("scenes"), error);
}

std::string beginning_of(const fs::path& file) {
  constexpr std::size_t enough = 4096;  // [bytes]
  std::string text(enough, '\0');
  std::ifstream stream(file);
  stream.read(text.data(), static_cast<std::streamsize>(enough));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

bool is_sentence_end(const std::string& word) {
  return word.ends_with('.') || word.ends_with(".)") || word.ends_with('?') || word.ends_with(':');
}

}  // namespace

std::string first_sentence(const std::string& scene) {
  const std::size_t begin = scene.find("<!--");
  if (begin == scene.npos || begin > scene.find("<argos-configuration")) return {};
  std::istringstream words(scene.substr(begin + 4, scene.find("-->", begin) - begin - 4));
  std::string sentence, word;
  while (words >> word) {
    sentence += (sentence.empty() ? "" : " ") + word;
    if (is_sentence_end(word)) break;
  }
  if (sentence.ends_with(':')) sentence.back() = '.';
  return sentence;
}

std::vector<InstalledScene> installed_scenes() {
  const fs::path folder = scenes_folder();
  std::vector<InstalledScene> scenes;
  std::set<fs::path> renamed;
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    const fs::path& path = it->path();
    if (path.filename() == "models") it.disable_recursion_pending();
    if (path.extension() != ".argos" || !it->is_regular_file(error)) continue;
    if (it->is_symlink(error)) renamed.insert(fs::canonical(path, error));
    const fs::path name = path.lexically_relative(folder).replace_extension();
    scenes.push_back({name.string(), path.string(), first_sentence(beginning_of(path))});
  }
  std::erase_if(scenes, [&](const auto& scene) { return renamed.contains(scene.path); });
  std::ranges::sort(scenes, {}, &InstalledScene::name);
  return scenes;
}

std::string scene_path(const std::string& word) {
  std::error_code error;
  if (word.empty() || fs::exists(word, error)) return word;
  const fs::path installed = scenes_folder() / (word + ".argos");
  if (!installed.is_relative() && fs::exists(installed, error)) return installed.string();
  if (word.find_first_of("./") != word.npos) return word;  // a path: its reader tells the rest
  std::vector<std::string> names;
  for (const auto& scene : installed_scenes()) names.push_back(scene.name);
  throw text::UsageError(fmt::format(
      "there is no file '{}', and no scene of that name is installed; {}", word,
      text::advice(word, names,
                   "write the path of a scene file, or a name that 'ziggurat scenes' lists")));
}

}  // namespace ziggurat::cli
