// SPDX-License-Identifier: MIT
#pragma once
// A fault, a warning or a notice about a scene file.

#include <compare>
#include <cstddef>
#include <string>

namespace ziggurat::scene {

/// A place in one of the files of a scene.
struct Location {
  std::size_t file = 0;  ///< index into Scene::files
  unsigned line = 0;     ///< from 1; 0 = nowhere in particular
  unsigned column = 0;   ///< from 1
  auto operator<=>(const Location&) const = default;
};

struct Problem {
  enum class Severity {
    notice,   ///< accepted, and without effect here
    warning,  ///< accepted, but probably not what was meant
    fault,    ///< the scene can't be run
  };
  Severity severity = Severity::fault;
  std::string file;
  Location where;
  std::string text;  ///< what is wrong, with the value; what would be right
};

/// `fault`, …, as in JSON.
constexpr const char* to_text(Problem::Severity severity) {
  return severity == Problem::Severity::fault     ? "fault"
         : severity == Problem::Severity::warning ? "warning"
                                                  : "notice";
}

/// Its text for people and programs: of names and values that the scene has in megabytes a part.
std::string text_of(const Problem& problem);

/// `file:line:column: text`, or `file: text` where no line is known.
std::string to_string(const Problem& problem);

}  // namespace ziggurat::scene
