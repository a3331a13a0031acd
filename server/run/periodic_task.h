#pragma once
// A function that another thread calls again and again.

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace ziggurat::run {

class PeriodicTask {
 public:
  /// @param interval  wall time before each call
  /// @param call      must not throw
  PeriodicTask(std::chrono::milliseconds interval, std::function<void()> call)
      : thread_([this, interval, call = std::move(call)] {
          std::unique_lock lock(mutex_);
          while (!end_.wait_for(lock, interval, [this] { return is_over_; })) call();
        }) {}
  /// Waits for a call that has begun.
  ~PeriodicTask() {
    {
      const std::lock_guard lock(mutex_);
      is_over_ = true;
    }
    end_.notify_one();
    thread_.join();
  }
  PeriodicTask(const PeriodicTask&) = delete;
  PeriodicTask& operator=(const PeriodicTask&) = delete;

 private:
  std::mutex mutex_;  // of the next one
  bool is_over_ = false;
  std::condition_variable end_;
  std::thread thread_;  // the last: it uses the others
};

}  // namespace ziggurat::run
