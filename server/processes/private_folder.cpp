#include "processes/private_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

#include "processes/folder_removal.h"

namespace ziggurat::processes {
namespace {

// A socket's path has at most 107 bytes; the part after the parent folder has less than 40.
constexpr std::size_t longest_parent = 64;
constexpr std::string_view prefix = "ziggurat-";
constexpr std::size_t name_length = prefix.size() + 6;
constexpr std::time_t young = 60;  // [s]: between being made and being locked
constexpr std::chrono::milliseconds patience{100};  // for what is put into a folder while it is removed

/// The descriptor of its lock, or -1 if a program that runs has it.
int lock(const std::string& folder, int flags) {
  const std::string path = folder + "/" + lock_name;
  const int file = ::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | flags, 0600);
  if (file < 0 || ::flock(file, LOCK_EX | LOCK_NB) == 0) return file;
  ::close(file);
  return -1;
}

/// Whether what is in a folder has names that runs give; also if nothing is.
bool has_only_ours(const std::string& folder) {
  const auto is_ours = [](const std::string& name) {
    constexpr std::array<std::string_view, 5> whole{"run", "socket", "files", "gnuplot.log", "python"};
    return name.starts_with("robots-") || name.starts_with("spawned-") || std::ranges::find(whole, name) != whole.end();
  };
  std::error_code error;
  auto it = std::filesystem::directory_iterator(folder, error);
  while (!error && it != std::filesystem::directory_iterator()) {
    if (!is_ours(it->path().filename().string())) return false;
    it.increment(error);
  }
  return !error;
}

/// Removes a folder whose program has ended. One without a lock is removed if it is old and has nothing but files of ours.
void remove_if_left(const std::string& folder) {
  struct stat status {};
  if (::lstat(folder.c_str(), &status) != 0) return;
  if (!S_ISDIR(status.st_mode) || status.st_uid != ::geteuid()) return;
  const int file = lock(folder, 0);
  if (file < 0) {
    struct stat of_lock {};
    const bool has_lock = ::lstat((folder + "/" + lock_name).c_str(), &of_lock) == 0;
    const bool is_old = status.st_mtime + young < std::time(nullptr);
    if (!has_lock && is_old && has_only_ours(folder)) remove_locked_folder(folder, patience);
    return;
  }
  remove_locked_folder(folder, patience);
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

/// The descriptor of the lock of a folder that was just made; -1 if another program took the folder for
/// one that was left, between the making of its lock and the locking, and removes it.
int lock_new(const std::string& folder) {
  const int file = lock(folder, O_CREAT);
  struct stat status {};
  if (file < 0 || (::fstat(file, &status) == 0 && status.st_nlink > 0)) return file;
  ::close(file);
  return -1;
}

/// A name that can't be guessed.
std::string random_name() {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  std::array<unsigned char, name_length - prefix.size()> random;
  if (::getentropy(random.data(), random.size()) != 0) {
    throw std::system_error(errno, std::generic_category(), "the system gives no random numbers");
  }
  std::string name(prefix);
  for (const unsigned char each : random) name += letters[each % letters.size()];
  return name;
}

/// A folder with its lock; an empty path and -1 if the parent takes none. The guardian has its name before it is
/// made: this program may be killed at any moment.
std::pair<std::string, int> make_locked(const std::string& parent, const Guardian* guardian) {
  constexpr int most_tries = 100;
  for (int i = 0; i < most_tries; ++i) {
    const std::string path = parent + "/" + random_name();
    if (guardian) guardian->remove_folder(path);
    const bool is_made = ::mkdir(path.c_str(), 0700) == 0;
    const int error = errno, file = is_made ? lock_new(path) : -1;
    if (file >= 0) return {path, file};
    if (is_made) ::rmdir(path.c_str());
    if (guardian) guardian->forget_folder(path);
    if (!is_made && error != EEXIST) return errno = error, std::pair{std::string(), -1};
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
  remove_locked_folder(path_, patience);
  if (lock_ >= 0) ::close(lock_);
}

}  // namespace ziggurat::processes
