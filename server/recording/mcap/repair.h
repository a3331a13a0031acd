#pragma once
// A new, whole file from what is intact in another one.

#include <cstdint>
#include <vector>

#include "recording/mcap/reader.h"
#include "recording/mcap/writer.h"

namespace ziggurat::mcap {

struct Repaired {
  std::uint64_t messages = 0, chunks = 0, attachments = 0;  ///< that were saved
  std::vector<Fault> lost;                                  ///< chunks and attachments
};

/// Damaged chunks and attachments are left out.
Repaired repair(const Reader& reader, Sink sink, Compression compression = Compression::zstd);

}  // namespace ziggurat::mcap
