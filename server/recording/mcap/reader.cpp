// SPDX-License-Identifier: MIT
#include "recording/mcap/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "recording/mcap/bytes.h"
#include "recording/mcap/compression.h"
#include "recording/mcap/scan.h"
#include "recording/mcap/summary.h"

namespace ziggurat::mcap {

Reader::Reader(Source source, const Limits& limits) : source_(std::move(source)), limits_(limits) {
  Header header = read_header(source_, limits_, faults_);
  try {
    contents_ = read_summary(source_, limits_).contents;
    has_summary_ = true;
  } catch (const Damaged& damaged) {
    faults_.push_back({damaged.offset(), damaged.what()});
    Scan scanned = scan(source_, limits_);
    contents_ = std::move(scanned.contents);
    for (Fault& fault : scanned.faults) faults_.push_back(std::move(fault));
  }
  contents_.header = std::move(header);
}

/// @param most  that its content may have [bytes]
std::string Reader::record(std::uint64_t offset, std::uint64_t length, Op op,
                           std::size_t most) const {
  if (offset > source_.size || length > source_.size - offset || length < record_head) {
    throw Damaged(offset, "an index refers to a place outside of the file");
  }
  if (length - record_head > most) {
    throw Damaged(offset, fmt::format("the record has {} bytes; at most {} are read",
                                      length - record_head, most));
  }
  std::string bytes;
  source_.read(offset, static_cast<std::size_t>(length), bytes);
  const RecordHead head = to_head(bytes);
  if (!head.is(op) || head.length != length - record_head) {
    throw Damaged(offset, "an index refers to a record that is not there");
  }
  return bytes;
}

std::string Reader::chunk(const ChunkIndex& index) const {
  const std::string bytes = record(index.offset, index.length, Op::chunk, limits_.chunk);
  return open_chunk(std::string_view(bytes).substr(record_head), index.offset, limits_).records;
}

std::string Reader::attachment(const AttachmentIndex& index) const {
  const std::string bytes = record(index.offset, index.length, Op::attachment, limits_.attachment);
  const auto attachment = to_attachment(std::string_view(bytes).substr(record_head));
  if (!attachment || !attachment->is_intact) {
    throw Damaged(index.offset, "the attachment is damaged: its CRC is wrong");
  }
  return std::string(attachment->data);
}

Metadata Reader::metadata(const MetadataIndex& index) const {
  const std::string bytes = record(index.offset, index.length, Op::metadata, limits_.record);
  auto metadata = to_metadata(std::string_view(bytes).substr(record_head));
  if (!metadata) throw Damaged(index.offset, "the metadata are damaged");
  return *std::move(metadata);
}

}  // namespace ziggurat::mcap
