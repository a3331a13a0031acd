// SPDX-License-Identifier: MIT
#pragma once
// The path of a robot's script on this machine.

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "script/folders.h"

namespace ziggurat::lua {

struct FoundScript {
  std::filesystem::path path;  ///< empty if there is none
  std::string fault;           ///< then: why, and what the server named; a server may learn it
  std::string where;  ///< then: the folders that were searched, for people at this machine only
};

/// Which files a server may name as scripts.
struct Nameable {
  const Folders& folders;  ///< that have them
  bool any_ending =
      false;  ///< otherwise only those that end with .lua: errors quote parts of a file
};

/// The server's path if it can be read here, otherwise the scene's, relative to the working
/// directory: the server may run on another machine. A server is not trusted: it can't choose
/// another file, and learns of none whether it exists.
/// @param resolved  the server's path
/// @param params    of the robot; `script` is the scene's path
FoundScript find_script(const std::string& resolved,
                        const std::vector<std::pair<std::string, std::string>>& params,
                        const Nameable& nameable);

}  // namespace ziggurat::lua
