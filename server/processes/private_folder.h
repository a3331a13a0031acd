#pragma once
// A folder that only this user can enter, for the socket and the files of one run.

#include <string>

namespace ziggurat::processes {

class PrivateFolder {
 public:
  /// Makes it in XDG_RUNTIME_DIR, otherwise in /tmp, with a path short enough for a socket in it.
  /// @throws std::system_error
  PrivateFolder();
  /// Removes it with everything in it.
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace ziggurat::processes
