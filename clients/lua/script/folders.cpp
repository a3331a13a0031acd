#include "script/folders.h"

#include <algorithm>
#include <stdexcept>
#include <system_error>

namespace ziggurat::lua {
namespace {

namespace fs = std::filesystem;

bool is_hidden(const fs::path& name) { return name.native().starts_with('.'); }

}  // namespace

Folders::Folders(const std::vector<fs::path>& folders) {
  for (const fs::path& folder : folders) {
    std::error_code error;
    folders_.push_back(fs::canonical(folder, error));
    if (error || !fs::is_directory(folders_.back(), error)) {
      throw std::runtime_error("--script-folder " + folder.string() +
                               ": is no folder; write the path of one");
    }
  }
}

bool Folders::contain(const fs::path& file) const {
  std::error_code error;
  const fs::path path = fs::weakly_canonical(fs::absolute(file, error), error);
  if (error) return false;
  // A link that leads nowhere could lead elsewhere when it is written to.
  if (fs::is_symlink(fs::symlink_status(path, error))) return false;
  return std::ranges::any_of(folders_, [&](const fs::path& folder) {
    const auto [rest, parted] = std::ranges::mismatch(path, folder);
    return parted == folder.end() && rest != path.end() &&
           std::none_of(rest, path.end(), is_hidden);
  });
}

std::string Folders::names() const {
  std::string text;
  for (const fs::path& folder : folders_) {
    text += (text.empty() ? "'" : ", '") + folder.string() + "'";
  }
  return text;
}

}  // namespace ziggurat::lua
