#pragma once
// Where the script of a robot is on this machine.

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace ziggurat::lua {

struct FoundScript {
  std::filesystem::path path;  ///< empty if there is none
  std::string fault;           ///< then: why, and what was tried
};

/// The server's path if it can be read here, else the scene's own words for it, seen from the
/// working directory: the server may run on another machine.
/// @param resolved  as the server says
/// @param params    of the robot; `script` is what the scene says
FoundScript find_script(const std::string& resolved,
                        const std::vector<std::pair<std::string, std::string>>& params);

}  // namespace ziggurat::lua
