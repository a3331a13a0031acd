// SPDX-License-Identifier: MIT
#pragma once
// A new, whole file from what is intact in another one.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "recording/mcap/reader.h"
#include "recording/mcap/writer.h"

namespace ziggurat::mcap {

struct Repaired {
  std::uint64_t messages = 0, chunks = 0, attachments = 0;  ///< that were saved
  std::vector<Fault> lost;                                  ///< chunks and attachments
};

/// Parts of a file that a copy has.
struct Kept {
  std::function<bool(const std::string& topic)> topics = {};  ///< empty: all
  bool messages_alone = false;  ///< no attachments, metadata and message indexes
};

/// Damaged chunks and attachments are left out.
Repaired repair(const Reader& reader, Sink sink, Compression compression = Compression::zstd,
                const Kept& kept = {});

}  // namespace ziggurat::mcap
