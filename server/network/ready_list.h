// SPDX-License-Identifier: MIT
#pragma once
// Which of many descriptors are ready, as the system tells it (epoll).

#include <sys/epoll.h>

#include <array>
#include <cstdint>
#include <optional>

#include "posix/descriptor.h"

namespace ziggurat::network {

class ReadyList {
 public:
  struct Ready {
    std::uint64_t id = 0;
    bool can_read = false;  ///< or the connection is over
    bool can_write = false;
    bool has_ended = false;  ///< the other end is closed; what it sent before can still be read
  };

  /// @throws std::system_error
  ReadyList();

  /// Events that a descriptor is waited for.
  struct Wanted {
    bool read = true, write = false;
  };
  void add(int descriptor, std::uint64_t id, Wanted wanted);
  void change(int descriptor, std::uint64_t id, Wanted wanted);
  void remove(int descriptor);

  /// Whether one is ready. It does not wait.
  bool look();
  /// One that is ready, in turn. It does not wait.
  std::optional<Ready> next();
  /// Some of those that the system told of were not given out yet.
  bool has_more() const { return next_ < count_; }
  /// Readable while one is ready.
  int number() const { return epoll_.number(); }

 private:
  posix::Descriptor epoll_;
  std::array<epoll_event, 64> events_{};
  int count_ = 0, next_ = 0;
};

}  // namespace ziggurat::network
