// SPDX-License-Identifier: MIT
#include "program/host.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <list>
#include <mutex>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>

#include "program/signals.h"
#include "program/turn.h"

namespace ziggurat::lua {
namespace {

/// One robot, on a thread of its own that mostly waits.
struct Guest {
  std::thread thread;
  bool is_over = false;  // guarded by `mutex`
  int code = 0;          // likewise
};

class Host {
 public:
  Host(const ProgramOptions& options, const RunRobot& run) : options_(options), run_(run) {}
  ~Host() { join_all(); }
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  void add(const std::string& id) {
    join_ended();
    Guest& guest = guests_.emplace_back();
    ProgramOptions options = options_;
    options.robots = {id};
    try {
      guest.thread = std::thread([this, &guest, options = std::move(options)] {
        const int code = run_(options);
        const std::lock_guard lock(mutex_);
        guest.code = code;
        guest.is_over = true;
      });
    } catch (const std::system_error&) {
      guests_.pop_back();
      throw std::runtime_error("robot '" + id + "' gets no thread: this process has " +
                               std::to_string(guests_.size()) +
                               " of them, and the system allows no more");
    }
  }
  int join_all() {
    for (Guest& guest : guests_) {
      guest.thread.join();
      code_ = std::max(code_, guest.code);
    }
    guests_.clear();
    return code_;
  }

 private:
  void join_ended() {
    guests_.remove_if([this](Guest& guest) {
      {
        const std::lock_guard lock(mutex_);
        if (!guest.is_over) return false;
      }
      guest.thread.join();
      code_ = std::max(code_, guest.code);
      return true;
    });
  }

  const ProgramOptions& options_;
  const RunRobot& run_;
  std::mutex mutex_;
  std::list<Guest> guests_;
  int code_ = 0;
};

/// Waits until the pipe can be read or a signal arrives. The program's own signals interrupt it.
bool wait_for(int pipe) {
  constexpr int slice_ms = 500;  // a signal may arrive just before
  while (arrived_signal() == 0) {
    pollfd ready{pipe, POLLIN, 0};
    if (::poll(&ready, 1, slice_ms) > 0) return true;
  }
  return false;
}

}  // namespace

int run_arriving_robots(const ProgramOptions& options, const RunRobot& run) {
  const int pipe = ::open(options.robots_from.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (pipe < 0)
    throw std::runtime_error("--robots-from " + options.robots_from + ": can't be read");
  block_script_signals();  // in this thread and in those that it starts; see Turn
  Host host(options, run);
  std::string text;
  char part[4096];
  while (wait_for(pipe)) {
    const ssize_t size = ::read(pipe, part, sizeof part);
    if (size < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (size <= 0) break;  // no more will come
    text.append(part, static_cast<std::size_t>(size));
    for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
      host.add(text.substr(0, end));
      text.erase(0, end + 1);
    }
  }
  ::close(pipe);
  return host.join_all();
}

}  // namespace ziggurat::lua
