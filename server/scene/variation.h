#pragma once
// Variation of a run against its scene file, apart from options with a name of their own.

#include <string>
#include <utility>
#include <vector>

namespace ziggurat::scene {

/// A value for all attributes that a path names: `--set`.
struct Setting {
  std::string path;  ///< XPath from the root element: `physics_engines/dynamics3d/@iterations`
  std::string value;
};

struct Variation {
  std::vector<Setting> settings;                                ///< in order: later ones win
  std::vector<std::pair<std::string, std::string>> parameters;  ///< names and values: `--param`
};

/// One line for each, for hashes; empty if there are none.
std::string to_text(const Variation& variation);

}  // namespace ziggurat::scene
