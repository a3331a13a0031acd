// SPDX-License-Identifier: MIT
#pragma once
// A team of threads that share the items of a loop. Items are independent of each other, so results
// do not depend on which thread takes which.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <type_traits>
#include <vector>

namespace ziggurat::dynamics {

class Team {
 public:
  /// @param threads  >= 1; the caller's is one of them
  /// @throws std::system_error if the system allows no more threads
  explicit Team(unsigned threads);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  unsigned size() const { return static_cast<unsigned>(workers_.size()) + 1; }

  /// Calls work(item, member) for the items 0 … count - 1, each once, and returns when all are
  /// done. A thread takes its own part of them first, the same in each loop: its cache has their
  /// data. Then it takes what others have left. The caller is member 0. Takes no memory.
  /// @throws the first exception of an item; the items that were not begun are left out then
  template <class Work>
  void share(std::size_t count, Work&& work) {
    using Body = std::remove_reference_t<Work>;
    run({[](void* body, std::size_t item, unsigned member) {
           (*static_cast<Body*>(body))(item, member);
         },
         const_cast<void*>(static_cast<const void*>(&work)), count});
  }

 private:
  struct Loop {
    void (*call)(void* body, std::size_t item, unsigned member) = nullptr;
    void* body = nullptr;
    std::size_t count = 0;
  };
  void run(const Loop& loop);
  void take_items(unsigned member);
  void take_part(unsigned part, unsigned member);
  void work(unsigned member);
  bool is_open(std::uint32_t state) const { return state % 2 == 1; }
  void end();

  /// A part of a loop's items, in a line of the cache.
  struct alignas(64) Part {
    std::atomic<std::size_t> next = 0;  // item that no thread has taken
    std::size_t last = 0;
  };
  Loop loop_;
  std::vector<Part> parts_;                // of each member
  std::atomic<std::uint32_t> state_ = 0;   // grows when a loop opens, to an odd number, and closes
  std::atomic<std::uint32_t> active_ = 0;  // workers that have seen it open
  std::atomic<bool> is_over_ = false;
  std::mutex mutex_;
  std::exception_ptr failure_;  // with mutex_
  std::vector<std::thread> workers_;
};

/// Calls work(item, member) for the items 0 … count - 1, each once. The threads of a team take
/// blocks of them. Without a team, and for few items, the caller does all.
/// @param block  items that a thread takes at once
template <class Work>
void share_in_blocks(Team* team, std::size_t count, std::size_t block, Work&& work) {
  constexpr std::size_t few = 64;
  if (!team || count < few) {
    for (std::size_t item = 0; item < count; ++item) work(item, 0U);
    return;
  }
  team->share((count + block - 1) / block, [&](std::size_t number, unsigned member) {
    const std::size_t last = std::min(count, (number + 1) * block);
    for (std::size_t item = number * block; item < last; ++item) work(item, member);
  });
}

}  // namespace ziggurat::dynamics
