// SPDX-License-Identifier: MIT
#pragma once
// The messages of a file, in its order.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "recording/mcap/reader.h"

namespace ziggurat::mcap {

struct Selection {
  std::vector<std::uint16_t> channels = {};                      ///< empty: all
  std::uint64_t from = 0;                                        ///< log time [ns]
  std::uint64_t to = std::numeric_limits<std::uint64_t>::max();  ///< included [ns]
};

/// Only chunks with such messages are read, one at a time.
class Messages {
 public:
  /// @param reader  must outlive this
  Messages(const Reader& reader, Selection selection);

  /// The next one; its data stay until the next call. Nothing: there are no more.
  /// @throws Damaged if its chunk is; the call after that continues with the next chunk
  std::optional<Message> next();

  /// The chunk of the last message: into Contents::chunks.
  std::size_t chunk() const { return next_chunk_ - 1; }

 private:
  bool is_wanted(const ChunkIndex& chunk) const;
  bool is_wanted(const Message& message) const;
  bool open_next_chunk();

  const Reader& reader_;
  Selection selection_;
  std::size_t next_chunk_ = 0;
  std::string records_;  // of the present chunk
  std::size_t at_ = 0;
};

}  // namespace ziggurat::mcap
