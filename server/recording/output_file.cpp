#include "recording/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace ziggurat::recording {
namespace {

constexpr std::size_t full_buffer = std::size_t{256} << 10;  // [bytes]

[[noreturn]] void fail(const std::string& path, int error) {
  throw WriteError(fmt::format("{}: cannot be written: {}", path == "-" ? "stdout" : path, std::strerror(error)));
}

}  // namespace

OutputFile::OutputFile(std::string path) : path_(std::move(path)) {
  descriptor_ = path_ == "-" ? ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3)
                             : ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
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
  // Some file systems report a full disk only here.
  if (::close(std::exchange(descriptor_, -1)) != 0) fail(path_, errno);
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
  }
  buffer_.clear();
}

}  // namespace ziggurat::recording
