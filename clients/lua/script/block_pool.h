// SPDX-License-Identifier: MIT
#pragma once
// Blocks of a few sizes, taken again and again, close together in chunks of an arena. A step of a
// script reads its state all over; where malloc() scatters a thousand states, each step waits for
// the memory.

#include <array>
#include <cstddef>
#include <new>
#include <span>

#include "script/arena.h"

namespace ziggurat::lua {

/// It keeps no block's size: give_back() is told it.
class BlockPool {
 public:
  /// @param arena  outlives the pool, and is this thread's; null: there is never a block
  explicit BlockPool(Arena* arena) : arena_(arena) {}

  /// @param size  > 0 [bytes]
  /// @return  null: it has no room, or the block is too large for it
  void* take(std::size_t size) {
    const std::size_t room = steps(size);
    if (room > most_steps) return nullptr;
    Unused* const block = unused_[room];
    if (block == nullptr) return cut(room);
    unused_[room] = block->next;
    return block;
  }
  /// @param block  one of its own;  @param size  as it was taken, or smaller
  void give_back(void* block, std::size_t size) {
    Unused*& last = unused_[steps(size)];
    last = new (block) Unused{last};
  }

  bool owns(const void* block) const { return arena_ != nullptr && arena_->owns(block); }
  /// Whether blocks of these sizes take the same room.
  static bool same_room(std::size_t a, std::size_t b) { return steps(a) == steps(b); }

 private:
  static constexpr std::size_t step = 16;  // rooms are multiples of it [bytes]
  // Size of a block. Larger ones are few, and mostly of what grows: a pool would use their room
  // for nothing else afterwards, malloc() does.
  static constexpr std::size_t most_steps = 512 / step;
  static std::size_t steps(std::size_t size) { return (size + step - 1) / step; }
  void* cut(std::size_t room);

  struct Unused {
    Unused* next;
  };
  Arena* arena_;
  std::size_t chunks_ = 0;
  std::span<std::byte> rest_;  // of the last chunk
  std::array<Unused*, most_steps + 1>
      unused_{};  // by their steps; the last that was given back is first
};

}  // namespace ziggurat::lua
