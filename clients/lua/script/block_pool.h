#pragma once
// Blocks of a few sizes, taken again and again, close together in given memory. A step of a script
// reads its state all over; where malloc() scatters a thousand states, each step waits for the
// memory.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace ziggurat::lua {

/// It keeps no block's size: give_back() is told it.
class BlockPool {
 public:
  /// @param memory  outlives the pool; aligned as malloc() aligns. Empty: there is never a block
  explicit BlockPool(std::span<std::byte> memory) : memory_(memory), rest_(memory) {}

  /// @param size  > 0 [bytes]
  /// @return  null: it has no room, or the block is too large for it
  void* take(std::size_t size);
  /// @param block  one of its own;  @param size  as it was taken, or smaller
  void give_back(void* block, std::size_t size);

  bool owns(const void* block) const {
    return reinterpret_cast<std::uintptr_t>(block) -
               reinterpret_cast<std::uintptr_t>(memory_.data()) <
           memory_.size();
  }
  /// Whether blocks of these sizes take the same room.
  static bool same_room(std::size_t a, std::size_t b) { return steps(a) == steps(b); }

 private:
  static constexpr std::size_t step = 16;                 // rooms are multiples of it [bytes]
  static constexpr std::size_t most_steps = 4096 / step;  // of a block
  static std::size_t steps(std::size_t size) { return (size + step - 1) / step; }

  struct Unused {
    Unused* next;
  };
  std::span<std::byte> memory_, rest_;
  std::array<Unused*, most_steps + 1>
      unused_{};  // by their steps; the last that was given back is first
};

}  // namespace ziggurat::lua
