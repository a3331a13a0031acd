// SPDX-License-Identifier: MIT
#pragma once
// A command of /bin/sh as words, as far as they can be read without a shell.

#include <optional>
#include <string>
#include <string_view>

namespace ziggurat::processes {

/// A part of a command.
struct Word {
  std::size_t begin = 0,
              size = 0;  ///< of its text in the command, quotes included; of size 0: there is none
  std::string text;      ///< without quotes
  bool is_literal = true;  ///< no shell is needed to read it
  bool is_quoted = false;  ///< some of it: it is no word of the shell itself then

  std::size_t end() const { return begin + size; }
};

/// The word at or behind a place of a command.
/// @param scene_folder  what $ZIGGURAT_SCENE_FOLDER stands for; none: only a shell knows it
Word word_at(std::string_view command, std::size_t place,
             const std::optional<std::string>& scene_folder);

/// The word that names the program which a command starts at last: behind assignments, exec, env,
/// nice and others that start another. It may be one that only a shell can read.
Word program_word(std::string_view command, const std::optional<std::string>& scene_folder);

}  // namespace ziggurat::processes
