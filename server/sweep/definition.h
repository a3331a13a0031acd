// SPDX-License-Identifier: MIT
#pragma once
// Definition that a folder of results belongs to: the experiment and the files that it was begun
// with. Kept in the folder as `experiment.json`.

#include <map>
#include <string>

#include "sweep/experiment.h"

namespace ziggurat::sweep {

struct Definition {
  Experiment experiment;
  std::map<std::string, std::string> files;  ///< SceneFiles::hashes
};

std::string to_json(const Definition& definition);
/// @param path  for messages. @throws text::UsageError if it is no such file
Definition definition_from_json(const std::string& text, const std::string& path);

/// @throws text::UsageError that names the first difference, if `now` has another experiment than
/// the folder, or a file has changed since
/// @param folder  for messages
void check_same(const Definition& kept, const Definition& now, const std::string& folder);

}  // namespace ziggurat::sweep
