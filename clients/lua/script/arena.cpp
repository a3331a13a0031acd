// SPDX-License-Identifier: MIT
#include "script/arena.h"

#include <sys/mman.h>

namespace ziggurat::lua {

Arena::Arena(std::size_t states) {
  constexpr std::size_t page = std::size_t{2} << 20;  // a large one [bytes]
  constexpr std::size_t many = 256;  // states; fewer would take more memory than they need
  const std::size_t total = (states * most_chunks * chunk + page - 1) / page * page;
  memory_.reset(static_cast<std::byte*>(std::aligned_alloc(page, total)));
  if (!memory_) return;
  size_ = total;
  if (states >= many) ::madvise(memory_.get(), total, MADV_HUGEPAGE);
}

std::span<std::byte> Arena::take() {
  if (size_ - taken_ < chunk) return {};
  const std::span<std::byte> next(memory_.get() + taken_, chunk);
  taken_ += chunk;
  return next;
}

}  // namespace ziggurat::lua
