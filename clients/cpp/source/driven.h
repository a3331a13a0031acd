// SPDX-License-Identifier: MIT
#pragma once
// Which thread drives which session of this program: a thread that waits for a supervisor's request
// can't answer for its sessions meanwhile.

#include <string>
#include <thread>
#include <vector>

namespace ziggurat {

/// A session, while it exists. Threads may make and ask at the same time.
class Driven {
 public:
  explicit Driven(std::string endpoint);
  ~Driven();
  Driven(const Driven&) = delete;
  Driven& operator=(const Driven&) = delete;

  /// @param id  of one of its robots, or its director
  void is(std::string id);
  /// By the thread that calls. Allocates nothing.
  void by_this_thread();

 private:
  friend std::vector<std::string> driven_here(const std::string& endpoint);
  std::string endpoint_;
  std::string id_;
  std::thread::id thread_;  // none: no thread has waited for its ticks yet
};

/// Ids, one of each session with this server that the calling thread drives. One that no thread has
/// begun yet may be that of a thread which is just starting: it has a second, and is the caller's
/// then.
std::vector<std::string> driven_here(const std::string& endpoint);

}  // namespace ziggurat
