#include "processes/robot_pipe.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace ziggurat::processes {

RobotPipe::RobotPipe(const std::string& path) {
  // Open for both ends, so that neither this nor a later write waits for a reader.
  if (::mkfifo(path.c_str(), 0600) == 0) {
    descriptor_ = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  }
  if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), path);
}

RobotPipe::~RobotPipe() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

RobotPipe::RobotPipe(RobotPipe&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

bool RobotPipe::send(const std::string& id) const {
  const std::string line = id + "\n";
  return ::write(descriptor_, line.data(), line.size()) == static_cast<ssize_t>(line.size());
}

}  // namespace ziggurat::processes
