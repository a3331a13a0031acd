#pragma once
// A fault, a warning or a notice about a scene file.

#include <string>

#include "scene/location.h"

namespace ziggurat::scene {

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
