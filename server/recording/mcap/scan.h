// SPDX-License-Identifier: MIT
#pragma once
// Reads a file from its start to its end, record by record, and checks everything: lengths, CRCs,
// indexes against what they refer to.

#include <string>
#include <string_view>
#include <vector>

#include "recording/mcap/contents.h"
#include "recording/mcap/source.h"

namespace ziggurat::mcap {

struct Scan {
  Contents contents;          ///< that is intact; statistics are counted
  bool has_end = false;       ///< the data section has an end
  std::uint64_t end = 0;      ///< offset of what is after it, then
  std::vector<Fault> faults;  ///< most_faults at most
  std::uint64_t damaged_chunks = 0;
};

/// @throws Damaged if the bytes do not begin as an MCAP file
Scan scan(const Source& source, const Limits& limits);

/// Everything that is wrong with a file, the summary included; nothing: it is whole, and none of
/// its bytes has changed, if its writer has computed all CRCs.
/// @throws Damaged if the bytes do not begin as an MCAP file
Scan check(const Source& source, const Limits& limits = {});

/// The first record. Its damage is added to the faults.
/// @throws Damaged if the bytes do not begin as an MCAP file
Header read_header(const Source& source, const Limits& limits, std::vector<Fault>& faults);

struct OpenedChunk {
  ChunkIndex index;     ///< without offset, length and message indexes
  std::string records;  ///< decompressed
};

/// @param content  of the record
/// @param offset   of the record, for messages
/// @throws Damaged if it is no chunk, is too large or does not have its CRC
OpenedChunk open_chunk(std::string_view content, std::uint64_t offset, const Limits& limits);

}  // namespace ziggurat::mcap
