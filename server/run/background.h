// SPDX-License-Identifier: MIT
#pragma once
// Work on a thread of its own, whose owner waits for it on a descriptor, beside others.

#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <functional>
#include <future>
#include <mutex>
#include <string>
#include <system_error>
#include <utility>

namespace ziggurat::run {

template <class Result>
class Background {
 public:
  struct Status {
    bool is_done = false;
    double progress = 0;  ///< 0 to 1
    std::string message;
  };
  /// Tells how far the work is, and what it does now.
  using Tell = std::function<void(double progress, std::string message)>;

  /// Begins at once. The thread has the signal mask of this one.
  explicit Background(std::function<Result(const Tell&)> work)
      : wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    if (wake_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
    const auto tell = [this](double progress, std::string message) {
      publish({.progress = progress, .message = std::move(message)});
    };
    result_ = std::async(std::launch::async, [this, tell, work = std::move(work)] {
      const AtEnd at_end{this};
      return work(tell);
    });
  }
  /// Waits until the work is done.
  ~Background() {
    if (result_.valid()) result_.wait();
    ::close(wake_);
  }
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  /// Readable after the status has changed.
  int descriptor() const { return wake_; }
  Status status() {
    eventfd_t ignored = 0;
    ::eventfd_read(wake_, &ignored);
    const std::lock_guard lock(mutex_);
    return status_;
  }
  /// Waits for the result. Once. @throws what the work has thrown
  Result take() { return result_.get(); }

 private:
  struct AtEnd {
    Background* owner;
    ~AtEnd() { owner->publish({.is_done = true, .progress = 1, .message = {}}); }
  };

  void publish(Status status) {
    {
      const std::lock_guard lock(mutex_);
      status_ = std::move(status);
    }
    ::eventfd_write(wake_, 1);
  }

  int wake_;
  std::mutex mutex_;  // of the next one
  Status status_;
  std::future<Result> result_;
};

}  // namespace ziggurat::run
