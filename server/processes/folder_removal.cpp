#include "processes/folder_removal.h"

#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <thread>

namespace ziggurat::processes {
namespace {

/// Whether nothing but the lock is left.
bool clear(const std::string& folder) {
  namespace fs = std::filesystem;
  bool is_clear = true;
  std::error_code error;
  for (fs::directory_iterator it(folder, error); !error && it != fs::directory_iterator(); it.increment(error)) {
    if (it->path().filename() == lock_name) continue;
    std::error_code fault;
    fs::remove_all(it->path(), fault);
    is_clear = is_clear && !fault;
  }
  return is_clear && !error;
}

bool remove_once(const std::string& folder) {
  if (::access(folder.c_str(), F_OK) != 0 && errno == ENOENT) return true;
  if (!clear(folder) || !clear(folder)) return false;  // once more: for what came behind the first look
  ::unlink((folder + "/" + lock_name).c_str());
  return ::rmdir(folder.c_str()) == 0 || errno == ENOENT;
}

}  // namespace

bool remove_locked_folder(const std::string& folder, std::chrono::milliseconds patience) noexcept {
  using clock = std::chrono::steady_clock;
  const auto end = clock::now() + patience;
  for (;;) {
    try {
      if (remove_once(folder)) return true;
    } catch (const std::exception&) {  // no memory: another time, perhaps
    }
    if (clock::now() >= end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

}  // namespace ziggurat::processes
