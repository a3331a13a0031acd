#include "script/regions.h"

#include <sys/mman.h>

namespace ziggurat::lua {

Regions::Regions(std::size_t count) {
  constexpr std::size_t page = std::size_t{2} << 20;  // a large one [bytes]
  const std::size_t total = (count * size + page - 1) / page * page;
  memory_.reset(static_cast<std::byte*>(std::aligned_alloc(page, total)));
  // A few states would take more memory so than they need, and gain nothing.
  if (memory_ && total > page) ::madvise(memory_.get(), total, MADV_HUGEPAGE);
}

std::span<std::byte> Regions::operator[](std::size_t index) const {
  if (!memory_) return {};
  return {memory_.get() + index * size, size};
}

}  // namespace ziggurat::lua
