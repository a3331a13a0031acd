// SPDX-License-Identifier: MIT
#include "processes/command_words.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "text/quoting.h"

namespace ziggurat::processes {
namespace {

constexpr std::string_view white = " \t\r\n";
constexpr std::array<std::string_view, 2> folder_names{"${ZIGGURAT_SCENE_FOLDER}",
                                                       "$ZIGGURAT_SCENE_FOLDER"};

/// A program that starts another one.
struct Starter {
  std::string_view name;
  std::string_view with_value;  ///< letters of its options whose value is a word of its own
  unsigned operands = 0;        ///< words between its options and the other program
};
constexpr std::array<Starter, 11> starters{{{"exec", "a"},
                                            {"env", "uC"},
                                            {"nice", "n"},
                                            {"nohup", ""},
                                            {"setsid", ""},
                                            {"time", "fo"},
                                            {"stdbuf", "ioe"},
                                            {"ionice", "cn"},
                                            {"chrt", "", 1},
                                            {"taskset", "", 1},
                                            {"timeout", "sk", 1}}};

/// Reads one word, character by character.
class Reader {
 public:
  Reader(std::string_view command, std::size_t begin,
         const std::optional<std::string>& scene_folder)
      : command_(command), scene_folder_(scene_folder), at_(begin) {
    word_.begin = begin;
  }

  Word read() {
    while (at_ < command_.size() && white.find(command_[at_]) == white.npos) part();
    word_.size = at_ - word_.begin;
    return std::move(word_);
  }

 private:
  void part() {
    const char c = command_[at_];
    if (c == '\'' || c == '"') return quoted(c);
    if (c == '$') return expansion();
    if (c == '\\' && at_ + 1 < command_.size()) {
      word_.is_quoted = true;
      ++at_;
    } else if (!text::is_plain_word(command_.substr(at_, 1)) && c != '=' && c != '%') {
      word_.is_literal = false;
    }
    word_.text += command_[at_++];
  }

  void quoted(char quote) {
    word_.is_quoted = true;
    for (++at_; at_ < command_.size() && command_[at_] != quote;) {
      const char c = command_[at_];
      if (quote == '"' && c == '$') {
        expansion();
        continue;
      }
      if (quote == '"' && c == '`') word_.is_literal = false;
      if (quote == '"' && c == '\\' && at_ + 1 < command_.size() &&
          std::string_view("$`\"\\\n").find(command_[at_ + 1]) != std::string_view::npos) {
        ++at_;
      }
      word_.text += command_[at_++];
    }
    if (at_ == command_.size()) word_.is_literal = false;  // the quote has no end
    at_ = std::min(at_ + 1, command_.size());
  }

  void expansion() {
    for (const std::string_view name : folder_names) {
      if (!scene_folder_ || !command_.substr(at_).starts_with(name)) continue;
      const char behind = at_ + name.size() < command_.size() ? command_[at_ + name.size()] : ' ';
      const bool is_longer =
          name.back() != '}' &&
          (std::isalnum(static_cast<unsigned char>(behind)) != 0 || behind == '_');
      if (is_longer) continue;
      word_.text += *scene_folder_;
      at_ += name.size();
      return;
    }
    word_.is_literal = false;
    word_.text += command_[at_++];
  }

  std::string_view command_;
  const std::optional<std::string>& scene_folder_;
  std::size_t at_;
  Word word_;
};

bool is_assignment(const Word& word) {
  const auto equals = word.text.find('=');
  return equals != std::string::npos && equals > 0 &&
         std::isdigit(static_cast<unsigned char>(word.text[0])) == 0 &&
         std::ranges::all_of(word.text.substr(0, equals),
                             [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
}

/// Whether the value of an option is the word behind it: of `-n 5`, not of `-n5` and
/// `--adjustment=5`.
bool takes_next(const Starter& starter, const std::string& option) {
  return option.size() == 2 && starter.with_value.find(option[1]) != std::string_view::npos;
}

}  // namespace

Word word_at(std::string_view command, std::size_t place,
             const std::optional<std::string>& scene_folder) {
  const std::size_t begin = std::min(command.find_first_not_of(white, place), command.size());
  return Reader(command, begin, scene_folder).read();
}

Word program_word(std::string_view command, const std::optional<std::string>& scene_folder) {
  const auto next = [&](const Word& word) { return word_at(command, word.end(), scene_folder); };
  Word word = word_at(command, 0, scene_folder);
  for (;;) {
    while (word.is_literal && is_assignment(word)) word = next(word);
    const std::string name = word.text.substr(word.text.rfind('/') + 1);
    const auto starter = std::ranges::find(starters, name, &Starter::name);
    if (!word.is_literal || starter == starters.end()) return word;
    Word behind = next(word);
    while (behind.is_literal && behind.text.starts_with('-')) {
      const bool skips = takes_next(*starter, behind.text);
      behind = next(behind);
      if (skips) behind = next(behind);
    }
    for (unsigned i = 0; i < starter->operands; ++i) behind = next(behind);
    if (behind.size == 0 && name != "exec") return word;  // `env` alone is a program, too
    word = std::move(behind);
  }
}

}  // namespace ziggurat::processes
