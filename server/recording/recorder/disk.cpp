// SPDX-License-Identifier: MIT
#include "recording/recorder/disk.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "outputs/output_file.h"

namespace ziggurat::recorder {

Disk::Disk(std::string path) : path_(std::move(path)) {
  if (path_ == "-") {
    throw outputs::WriteError(
        "a recording needs a file; write its name instead of -, or /dev/stdout");
  }
  // A pipe without a reader is an error, not a wait.
  descriptor_ = outputs::open_alone(path_, O_NONBLOCK);
  ::fcntl(descriptor_, F_SETFL, O_APPEND);  // from now on writes wait
}

Disk::~Disk() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void Disk::fail(int error) {
  throw outputs::WriteError(fmt::format("{}: cannot be written: {}", path_, std::strerror(error)));
}

void Disk::check_loss() const {
  const auto loss = outputs::loss_of(descriptor_, size_);
  if (loss) throw outputs::WriteError(fmt::format("{}: {}", path_, *loss));
}

void Disk::write(std::string_view bytes) {
  // [bytes] at once: a disk that takes as much within the patience is seen to go on.
  constexpr std::size_t piece = std::size_t{1} << 16;
  check_loss();
  for (std::string_view left = bytes; !left.empty();) {
    const ssize_t count = ::write(descriptor_, left.data(), std::min(left.size(), piece));
    if (count >= 0 && !is_abandoned_) {
      left.remove_prefix(static_cast<std::size_t>(count));
      taken_ += static_cast<std::uint64_t>(count);
    } else if (is_abandoned_ || errno != EINTR) {
      const int error = is_abandoned_ ? ECANCELED : errno;
      // A pipe cannot be cut; its reader sees the end of the file.
      [[maybe_unused]] const int ignored = ::ftruncate(descriptor_, static_cast<off_t>(size_));
      fail(error);
    }
  }
  size_ += bytes.size();
}

void Disk::close() {
  if (descriptor_ < 0) return;
  check_loss();
  // Some file systems report a full disk only here.
  if (::close(std::exchange(descriptor_, -1)) != 0) fail(errno);
}

}  // namespace ziggurat::recorder
