// SPDX-License-Identifier: MIT
#include "script/folders.h"

#include <algorithm>
#include <stdexcept>
#include <system_error>

namespace ziggurat::lua {
namespace {

namespace fs = std::filesystem;

bool is_hidden(const fs::path& name) { return name.native().starts_with('.'); }

bool is_one_of(const std::vector<fs::path>& files, const fs::path& file) {
  std::error_code error;
  return std::ranges::any_of(
      files, [&](const fs::path& each) { return fs::equivalent(each, file, error); });
}

}  // namespace

Folders::Folders(const std::vector<fs::path>& folders, Exceptions exceptions)
    : exceptions_(std::move(exceptions)) {
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
  if (is_one_of(exceptions_.hidden, path)) return false;
  return std::ranges::any_of(folders_, [&](const fs::path& folder) {
    const auto [rest, parted] = std::ranges::mismatch(path, folder);
    return parted == folder.end() && rest != path.end() &&
           std::none_of(rest, path.end(), is_hidden);
  });
}

bool Folders::is_read_only(const fs::path& file) const {
  return is_one_of(exceptions_.read_only, file);
}

std::string Folders::names() const {
  std::string text;
  for (const fs::path& folder : folders_) {
    text += (text.empty() ? "'" : ", '") + folder.string() + "'";
  }
  return text;
}

}  // namespace ziggurat::lua
