// SPDX-License-Identifier: MIT
#include "outputs/output_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "posix/descriptor.h"

namespace ziggurat::outputs {
namespace {

constexpr std::size_t full_buffer = std::size_t{256} << 10;  // [bytes]

[[noreturn]] void fail(const std::string& path, int error) {
  throw WriteError(fmt::format("{}: cannot be written: {}", path == "-" ? "stdout" : path,
                               std::strerror(error)));
}

}  // namespace

int open_alone(const std::string& path, int flags) {
  const int file = ::open(path.c_str(), flags | O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0) fail(path, errno);
  struct stat status {};
  if (::fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) return file;
  const bool is_taken = ::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  if (!is_taken && ::ftruncate(file, 0) == 0) return file;
  const int error = errno;
  ::close(file);
  if (!is_taken) fail(path, error);
  throw WriteError(path + ": cannot be written: another program writes to it; name another file");
}

void check_can_be_written(const std::string& path) {
  constexpr int flags = O_WRONLY | O_CREAT | O_CLOEXEC;
  const posix::Descriptor made(::open(path.c_str(), flags | O_EXCL, 0666));
  if (made.is_open()) {
    ::unlink(path.c_str());
  } else if (errno != EEXIST || !posix::Descriptor(::open(path.c_str(), flags, 0666)).is_open()) {
    fail(path, errno);
  }
}

std::optional<std::string> loss_of(int descriptor, std::uint64_t size) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  if (status.st_nlink == 0) return "was removed while it was written, and is lost";
  const auto now = static_cast<std::uint64_t>(status.st_size);
  if (now >= size) return std::nullopt;
  return fmt::format(
      "was shortened by another program while it was written: {} bytes of {} are lost", size - now,
      size);
}

OutputFile::OutputFile(std::string path) : path_(std::move(path)) {
  descriptor_ = path_ == "-" ? ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3) : open_alone(path_);
  if (descriptor_ < 0) fail(path_, errno);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::written() {
  if (buffer_.size() >= full_buffer) flush();
}

void OutputFile::close() {
  if (descriptor_ < 0) return;
  flush();
  const auto loss = loss_of(descriptor_, size_);
  // Some file systems report a full disk only here.
  if (::close(std::exchange(descriptor_, -1)) != 0) fail(path_, errno);
  if (loss) throw WriteError(fmt::format("{}: {}", path_, *loss));
}

void OutputFile::flush() {
  if (descriptor_ < 0) return;  // it was closed by an error that was reported
  const char* next = buffer_.data();
  std::size_t left = buffer_.size();
  while (left > 0) {
    const ssize_t count = ::write(descriptor_, next, left);
    if (count < 0) {
      if (errno == EINTR) continue;
      const int error = errno;
      buffer_.clear();
      ::close(std::exchange(descriptor_, -1));
      fail(path_, error);
    }
    next += count;
    left -= static_cast<std::size_t>(count);
    size_ += static_cast<std::uint64_t>(count);
  }
  buffer_.clear();
}

}  // namespace ziggurat::outputs
