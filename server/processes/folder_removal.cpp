#include "processes/folder_removal.h"

#include <unistd.h>

#include <filesystem>
#include <system_error>

namespace ziggurat::processes {

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
