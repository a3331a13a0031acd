#include "processes/private_folder.h"

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <vector>

namespace ziggurat::processes {
namespace {

// A socket's path has at most 107 bytes; the part after the parent folder has less than 40.
constexpr std::size_t longest_parent = 64;

}  // namespace

PrivateFolder::PrivateFolder() {
  std::vector<std::string> parents;
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  if (runtime && runtime[0] == '/' && std::string(runtime).size() <= longest_parent) {
    parents.emplace_back(runtime);
  }
  parents.emplace_back("/tmp");
  for (const auto& parent : parents) {
    std::string name = parent + "/ziggurat-XXXXXX";
    if (::mkdtemp(name.data())) {  // mode 0700
      path_ = name;
      return;
    }
  }
  throw std::system_error(errno, std::generic_category(), "cannot make a folder in /tmp");
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace ziggurat::processes
