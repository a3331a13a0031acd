#include "script/block_pool.h"

#include <new>

namespace ziggurat::lua {

void* BlockPool::take(std::size_t size) {
  const std::size_t room = steps(size);
  if (room > most_steps) return nullptr;
  if (Unused* const block = unused_[room]) {
    unused_[room] = block->next;
    return block;
  }
  if (room * step > rest_.size()) return nullptr;
  void* const block = rest_.data();
  rest_ = rest_.subspan(room * step);
  return block;
}

void BlockPool::give_back(void* block, std::size_t size) {
  Unused*& last = unused_[steps(size)];
  last = new (block) Unused{last};
}

}  // namespace ziggurat::lua
