// SPDX-License-Identifier: MIT
#include "text/buffered_stream.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <limits.h>
#include <poll.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

namespace ziggurat::text {

BufferedStream::BufferedStream(int descriptor, std::size_t most)
    : descriptor_(descriptor), most_(most) {
  struct stat status {};
  const bool is_known = ::fstat(descriptor, &status) == 0;
  is_file_ = !is_known || S_ISREG(status.st_mode);
  if (!is_known || !(S_ISFIFO(status.st_mode) || S_ISCHR(status.st_mode))) return;
  // O_NONBLOCK on the descriptor itself would hold for all programs that share it, the shell among
  // them.
  const std::string path = fmt::format("/proc/self/fd/{}", descriptor);
  own_ = ::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
}

BufferedStream::~BufferedStream() {
  if (own_ >= 0) ::close(own_);
}

void BufferedStream::add(std::string_view text) {
  if (waiting_.size() - begin_ + text.size() > most_) {
    ++dropped_;
  } else {
    waiting_ += text;
  }
}

void BufferedStream::add_always(std::string_view text) { waiting_ += text; }

/// @returns an error number; EAGAIN if the reader does not take anything now
int BufferedStream::write_once(int wait_ms) {
  const bool can_block = own_ < 0 && !is_file_;
  pollfd ready{own_ >= 0 ? own_ : descriptor_, POLLOUT, 0};
  if ((wait_ms != 0 || can_block) && ::poll(&ready, 1, wait_ms) == 0) return EAGAIN;
  // A pipe that is ready takes this much at least without waiting.
  const std::size_t left = waiting_.size() - begin_;
  const std::size_t size = can_block ? std::min<std::size_t>(left, PIPE_BUF) : left;
  const ssize_t count = ::write(ready.fd, waiting_.data() + begin_, size);
  if (count < 0) return errno == EINTR ? 0 : errno;
  begin_ += static_cast<std::size_t>(count);
  return 0;
}

int BufferedStream::write() {
  while (!is_empty()) {
    const int error = write_once(0);
    if (error == EAGAIN) break;
    if (error != 0) return error;
  }
  if (is_empty() || begin_ > most_) {
    waiting_.erase(0, begin_);
    begin_ = 0;
  }
  return 0;
}

int BufferedStream::finish(std::chrono::milliseconds most) {
  const auto end = std::chrono::steady_clock::now() + most;
  while (!is_empty()) {
    const auto rest =
        std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    if (most.count() >= 0 && rest.count() <= 0) break;
    const int error = write_once(most.count() < 0 ? -1 : static_cast<int>(rest.count()));
    if (error != 0 && error != EAGAIN) return error;
  }
  return write();
}

std::uint64_t BufferedStream::take_dropped() { return std::exchange(dropped_, 0); }

void prepare_output() {
  open_standard_streams();
  ::signal(SIGXFSZ, SIG_IGN);
}

void open_standard_streams() {
  int file = 0;
  do {
    file = ::open("/dev/null", O_RDWR);  // the lowest number that is free
  } while (file >= 0 && file <= STDERR_FILENO);
  if (file > STDERR_FILENO) ::close(file);
}

}  // namespace ziggurat::text
