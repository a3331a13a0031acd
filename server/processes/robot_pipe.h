#pragma once
// Ids of robots for a process that runs already: it opens the pipe by its path and reads one id a
// line.

#include <string>

namespace ziggurat::processes {

class RobotPipe {
 public:
  /// @param path  of the pipe, which is made there
  /// @throws std::system_error
  explicit RobotPipe(const std::string& path);
  ~RobotPipe();
  RobotPipe(RobotPipe&& other) noexcept;
  RobotPipe& operator=(RobotPipe&&) = delete;

  /// It never waits. False if too much waits to be read.
  bool send(const std::string& id) const;

 private:
  int descriptor_ = -1;
};

}  // namespace ziggurat::processes
