#pragma once
// Resolved path of an output, and the owners of its parts.

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

#include "posix/descriptor.h"

namespace ziggurat::recording {

/// Walks to where a path leads, from folder to folder and along links, and looks at who has put each of them there. What was
/// looked at stays open, so that it is not exchanged before the file is opened.
class OutputPath {
 public:
  /// See error() and planted() before the rest is used.
  explicit OutputPath(const std::string& path);

  int error() const { return error_; }  ///< of the system: a folder is not there, or can't be entered
  /// Description of a planted part: another user put it on the way, or at the end, where all can
  /// write. The same holds below a folder that is planted.
  const std::optional<std::string>& planted() const { return planted_; }

  /// Opens the file.
  /// @return  its descriptor, or -1 with an error of the system
  int open(int flags) const;
  /// Removes a file that open() has made.
  void remove() const;

 private:
  struct Folder {
    posix::Descriptor opened;
    uid_t owner = 0;
    bool all_can_write = false;
    bool is_planted = false;  ///< by another user, in a folder that all can write, or below one that is planted
  };

  void push_names(const std::string& path);
  void start_at(const char* folder);
  void enter(posix::Descriptor opened, bool is_planted);
  void step();
  static bool is_foreign(const Folder& parent, uid_t owner);
  void reject(const Folder& parent, mode_t mode, bool is_last);
  void follow(const posix::Descriptor& link, bool is_last);

  std::vector<Folder> folders_;    // from the first on
  std::vector<std::string> remaining_;  // names that are still to come, the next one last
  std::string name_;
  bool is_of_proc_ = false;
  int followed_links_ = 0, error_ = 0;
  std::optional<std::string> planted_;
};

}  // namespace ziggurat::recording
