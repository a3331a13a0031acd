// SPDX-License-Identifier: MIT
#pragma once
// The files that a recording contains: its scene is read from them and from nothing else.

#include <filesystem>
#include <map>
#include <string>

#include "scene/files.h"

namespace ziggurat::replay {

class EmbeddedFiles {
 public:
  /// @param name  the path as the reader of the scene asked for it
  void add(const std::string& name, std::string bytes);
  /// Null: it is not embedded.
  const std::string* find(const std::filesystem::path& path) const;
  /// By normal path.
  const std::map<std::string, std::string>& all() const { return files_; }
  /// Opens embedded files and refuses all others; never reads the disk. This must outlive it.
  scene::OpenFile opener() const;

 private:
  std::map<std::string, std::string> files_;  // by normal path
};

}  // namespace ziggurat::replay
