#include "run/page_folder.h"

#include <filesystem>
#include <system_error>

namespace ziggurat::run {

std::string page_folder() {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  return (program.parent_path().parent_path() / "share/ziggurat/web").string();
}

}  // namespace ziggurat::run
