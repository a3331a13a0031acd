// SPDX-License-Identifier: MIT
#pragma once
// Reads an MCAP file, of anyone: every length is checked against what is left, memory is bounded by
// Limits. With a summary only that is read at first; a file without a good one, as after kill -9,
// is scanned from its start.

#include <cstdint>
#include <string>
#include <vector>

#include "recording/mcap/contents.h"
#include "recording/mcap/decode.h"
#include "recording/mcap/source.h"

namespace ziggurat::mcap {

class Reader {
 public:
  /// @throws Damaged if the bytes do not begin as an MCAP file; std::runtime_error if they can't
  /// be read
  explicit Reader(Source source, const Limits& limits = {});

  const Contents& contents() const { return contents_; }
  /// The file has an end, and its summary is good. Chunks may be damaged nevertheless: check().
  bool has_summary() const { return has_summary_; }
  /// Damage of the summary, and if that is not good, any damage.
  const std::vector<Fault>& faults() const { return faults_; }

  /// The records of a chunk, decompressed; its CRC was right. @throws Damaged
  std::string chunk(const ChunkIndex& index) const;
  /// The data of an attachment; its CRC was right. @throws Damaged
  std::string attachment(const AttachmentIndex& index) const;
  /// @throws Damaged
  Metadata metadata(const MetadataIndex& index) const;

 private:
  std::string record(std::uint64_t offset, std::uint64_t length, Op op, std::size_t most) const;

  Source source_;
  Limits limits_;
  Contents contents_;
  bool has_summary_ = false;
  std::vector<Fault> faults_;
};

}  // namespace ziggurat::mcap
