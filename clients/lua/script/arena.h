// SPDX-License-Identifier: MIT
#pragma once
// Memory for many states, side by side: the system can hold it in large pages. Each state takes a
// chunk when it needs one.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>

namespace ziggurat::lua {

/// Its chunks are not given back before its end.
class Arena {
 public:
  /// An odd number of the cache's lines [bytes]: the chunks do not begin in the same few sets.
  static constexpr std::size_t chunk = 4096 + 64;
  static constexpr std::size_t most_chunks = 48;  ///< of a state; what it needs more is elsewhere

  /// If there is no memory for so many states, it has none.
  explicit Arena(std::size_t states);
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  /// The next chunk; empty if all have been taken.
  std::span<std::byte> take();

  bool owns(const void* block) const {
    return reinterpret_cast<std::uintptr_t>(block) -
               reinterpret_cast<std::uintptr_t>(memory_.get()) <
           size_;
  }

 private:
  struct Free {
    void operator()(std::byte* memory) const { std::free(memory); }
  };
  std::unique_ptr<std::byte, Free> memory_;
  std::size_t size_ = 0, taken_ = 0;  // [bytes]
};

}  // namespace ziggurat::lua
