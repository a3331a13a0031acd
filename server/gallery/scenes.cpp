// SPDX-License-Identifier: MIT
#include "gallery/scenes.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <system_error>

#include "text/printable.h"

namespace ziggurat::gallery {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t read_most = std::size_t{64} << 10;  // [bytes] of a file
constexpr int deepest = 4;
constexpr std::size_t longest_sentence = 300;  // [bytes]

bool is_space(char letter) { return std::isspace(static_cast<unsigned char>(letter)) != 0; }

std::string beginning_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string text(read_most, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

/// A full stop ends a sentence before white space, unless it follows a single letter, as in "z.".
bool is_end(const std::string& text, std::size_t i) {
  if (text[i] != '.' && text[i] != '?' && text[i] != '!') return false;
  const bool is_last = i + 1 == text.size() || is_space(text[i + 1]);
  return is_last && !(i >= 2 && text[i - 2] == ' ');
}

}  // namespace

std::string first_sentence(std::string_view xml) {
  const auto begin = xml.find("<!--");
  if (begin == std::string_view::npos) return {};
  const std::string_view comment = xml.substr(begin + 4, xml.find("-->", begin) - begin - 4);
  std::string sentence;
  for (const char letter : comment) {
    if (!is_space(letter)) {
      sentence += letter;
    } else if (!sentence.empty() && sentence.back() != ' ') {
      if (is_end(sentence, sentence.size() - 1)) break;
      sentence += ' ';
    }
  }
  while (!sentence.empty() && sentence.back() == ' ') sentence.pop_back();
  return text::printable_part(sentence, longest_sentence);
}

std::vector<Scene> scenes_below(const fs::path& folder) {
  std::vector<Scene> scenes;
  fs::recursive_directory_iterator entries(folder, fs::directory_options::skip_permission_denied);
  for (std::error_code error; entries != fs::recursive_directory_iterator();
       entries.increment(error)) {
    const fs::directory_entry& entry = *entries;
    const bool is_link = entry.is_symlink(error);
    if (is_link || entry.path().filename().string().starts_with('.') ||
        entries.depth() == deepest) {
      entries.disable_recursion_pending();
      continue;
    }
    if (!entry.is_regular_file(error) || entry.path().extension() != ".argos") continue;
    const std::string text = beginning_of(entry.path());
    if (text.find("<argos-configuration") == std::string::npos) continue;
    fs::path name = entry.path().lexically_relative(folder);
    scenes.push_back({entry.path(), name.replace_extension().string(), first_sentence(text)});
    if (scenes.size() == most_scenes) break;
  }
  std::ranges::sort(scenes, {}, &Scene::name);
  return scenes;
}

}  // namespace ziggurat::gallery
