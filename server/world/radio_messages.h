// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ziggurat::world {

/// Messages of radios. Their bytes stand in one buffer, and may be shared by several messages.
struct RadioMessages {
  struct Entry {
    std::size_t radio = 0;   ///< into Layout::radios
    std::size_t begin = 0;   ///< into `bytes`
    std::size_t size = 0;    ///< [bytes], may be 0
    std::size_t sender = 0;  ///< of a message that was received: into Layout::radios
  };
  std::vector<Entry> entries;
  std::vector<std::uint8_t> bytes;
  std::uint64_t left_out = 0;  ///< that would have been received, too, if they were not too many

  std::span<const std::uint8_t> payload(const Entry& entry) const {
    return std::span(bytes).subspan(entry.begin, entry.size);
  }
  void add(std::size_t radio, std::span<const std::uint8_t> payload) {
    entries.push_back({radio, bytes.size(), payload.size()});
    bytes.insert(bytes.end(), payload.begin(), payload.end());
  }
  void clear() {  ///< keeps the memory
    entries.clear();
    bytes.clear();
    left_out = 0;
  }
};

}  // namespace ziggurat::world
