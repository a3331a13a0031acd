// SPDX-License-Identifier: MIT
#include "script/block_pool.h"

#include <algorithm>

namespace ziggurat::lua {

/// A new block.
void* BlockPool::cut(std::size_t room) {
  if (room * step > rest_.size()) {
    if (arena_ == nullptr || chunks_ == Arena::most_chunks) return nullptr;
    const std::span<std::byte> chunk = arena_->take();
    if (chunk.empty()) return nullptr;
    ++chunks_;
    const std::size_t left = std::min(rest_.size() / step, most_steps);
    if (left > 0) give_back(rest_.data(), left * step);
    rest_ = chunk;
  }
  void* const block = rest_.data();
  rest_ = rest_.subspan(room * step);
  return block;
}

}  // namespace ziggurat::lua
