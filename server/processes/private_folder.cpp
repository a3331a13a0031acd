// SPDX-License-Identifier: MIT
#include "processes/private_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

namespace ziggurat::processes {
namespace {

// A socket's path has at most 107 bytes; the part after the parent folder has less than 40.
constexpr std::size_t longest_parent = 64;
constexpr std::string_view prefix = "ziggurat-";
constexpr std::size_t name_length = prefix.size() + 6;

/// The descriptor of its lock, or -1 if a program that runs has it.
int lock(const std::string& folder, int flags) {
  const std::string path = folder + "/" + lock_name;
  const int file = ::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | flags, 0600);
  if (file < 0 || ::flock(file, LOCK_EX | LOCK_NB) == 0) return file;
  ::close(file);
  return -1;
}

/// Removes a folder whose program has ended. One without a lock is removed if it is empty.
void remove_if_left(const std::string& folder) {
  struct stat status {};
  if (::lstat(folder.c_str(), &status) != 0 || !S_ISDIR(status.st_mode) ||
      status.st_uid != ::geteuid())
    return;
  const int file = lock(folder, 0);
  if (file < 0) {
    ::rmdir(folder.c_str());
    return;
  }
  remove_locked_folder(folder);
  ::close(file);
}

void remove_left_folders(const std::string& parent) {
  std::error_code error;
  std::vector<std::string> found;
  for (auto it = std::filesystem::directory_iterator(parent, error);
       !error && it != std::filesystem::directory_iterator(); it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (name.size() == name_length && name.starts_with(prefix)) found.push_back(it->path());
  }
  for (const std::string& folder : found) remove_if_left(folder);
}

/// The descriptor of the lock of a folder that was just made; -1 if another program took the folder
/// for one that was left, between the making of its lock and the locking, and removes it.
int lock_new(const std::string& folder) {
  const int file = lock(folder, O_CREAT);
  struct stat status {};
  if (file < 0 || (::fstat(file, &status) == 0 && status.st_nlink > 0)) return file;
  ::close(file);
  return -1;
}

/// A folder with its lock; an empty path and -1 if the parent takes none.
std::pair<std::string, int> make_locked(const std::string& parent, const Guardian* guardian) {
  constexpr int most_tries = 100;
  for (int i = 0; i < most_tries; ++i) {
    std::string path = parent + "/" + std::string(prefix) + "XXXXXX";
    if (::mkdtemp(path.data()) == nullptr) break;
    if (guardian)
      guardian->remove_folder(
          path);  // before anything is in it: this program may be killed at any moment
    const int file = lock_new(path);
    if (file >= 0) return {path, file};
    ::rmdir(path.c_str());
  }
  return {{}, -1};
}

}  // namespace

PrivateFolder::PrivateFolder(const Guardian* guardian) {
  std::vector<std::string> parents;
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  if (runtime && runtime[0] == '/' && std::string(runtime).size() <= longest_parent) {
    parents.emplace_back(runtime);
  }
  parents.emplace_back("/tmp");
  for (const auto& parent : parents) {
    remove_left_folders(parent);
    std::tie(path_, lock_) = make_locked(parent, guardian);
    if (lock_ >= 0) return;
  }
  throw std::system_error(errno, std::generic_category(), "cannot make a folder in /tmp");
}

PrivateFolder::~PrivateFolder() {
  remove_locked_folder(path_);
  if (lock_ >= 0) ::close(lock_);
}

void remove_locked_folder(const std::string& folder) noexcept try {
  namespace fs = std::filesystem;
  std::error_code error;
  bool is_clear = true;
  for (fs::directory_iterator it(folder, error); !error && it != fs::directory_iterator();
       it.increment(error)) {
    if (it->path().filename() == lock_name) continue;
    std::error_code fault;
    fs::remove_all(it->path(), fault);
    is_clear = is_clear && !fault;
  }
  if (error || !is_clear) return;
  ::unlink((folder + "/" + lock_name).c_str());
  ::rmdir(folder.c_str());
} catch (const std::exception&) {  // no memory: the next start removes it
}

}  // namespace ziggurat::processes
