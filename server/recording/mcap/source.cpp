// SPDX-License-Identifier: MIT
#include "recording/mcap/source.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include "posix/descriptor.h"

namespace ziggurat::mcap {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& why) {
  throw std::runtime_error(fmt::format("{}: cannot be read: {}", path, why));
}

void read_whole(int descriptor, const std::string& path, std::uint64_t offset, std::size_t size,
                std::string& to) {
  const std::size_t begin = to.size();
  to.resize(begin + size);
  for (std::size_t done = 0; done < size;) {
    const ssize_t count = ::pread(descriptor, to.data() + begin + done, size - done,
                                  static_cast<off_t>(offset + done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(path, std::strerror(errno));
    if (count == 0) throw Damaged(offset + done, "the file has become shorter");
    done += static_cast<std::size_t>(count);
  }
}

}  // namespace

Source open_file(const std::string& path) {
  const auto file = std::make_shared<const posix::Descriptor>(
      ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!file->is_open()) fail(path, std::strerror(errno));
  struct stat status {};
  if (::fstat(file->number(), &status) != 0) fail(path, std::strerror(errno));
  if (!S_ISREG(status.st_mode)) fail(path, "it is not a regular file");
  return {static_cast<std::uint64_t>(status.st_size),
          [file, path](std::uint64_t offset, std::size_t size, std::string& to) {
            read_whole(file->number(), path, offset, size, to);
          }};
}

Source bytes_of(std::string_view bytes) {
  return {bytes.size(), [bytes](std::uint64_t offset, std::size_t size, std::string& to) {
            if (offset > bytes.size() || size > bytes.size() - offset) {
              throw Damaged(offset, "the bytes end there");
            }
            to += bytes.substr(static_cast<std::size_t>(offset), size);
          }};
}

}  // namespace ziggurat::mcap
