// SPDX-License-Identifier: MIT
#include "script/place_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <stdexcept>

namespace ziggurat::lua {
namespace {

constexpr std::size_t size = 1024;

char* mapped = nullptr;  // of the process, as signals are

}  // namespace

void open_place_file(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  void* memory = MAP_FAILED;
  if (file >= 0 && ::ftruncate(file, size) == 0) {
    memory = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  }
  const int error = errno;
  if (file >= 0) ::close(file);
  if (memory == MAP_FAILED) {
    throw std::runtime_error("--place-file " + path +
                             ": can't be written: " + std::strerror(error));
  }
  mapped = static_cast<char*>(memory);
}

void write_place(const char* robot, const char* place) noexcept {
  if (mapped == nullptr) return;
  std::size_t at = 0;
  const auto add = [&](const char* text) {
    while (*text != '\0' && at + 2 < size) mapped[at++] = *text++;
  };
  add(robot);
  mapped[at++] = '\n';
  add(place);
  mapped[at] = '\0';
}

}  // namespace ziggurat::lua
