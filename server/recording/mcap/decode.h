// SPDX-License-Identifier: MIT
#pragma once
// The contents of records, from bytes. Nothing: the bytes are not that record.

#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "recording/mcap/records.h"

namespace ziggurat::mcap {

struct RecordHead {
  std::uint8_t op = 0;
  std::uint64_t length = 0;  ///< of the content [bytes]

  bool is(Op other) const { return op == static_cast<std::uint8_t>(other); }
};

/// @param bytes  record_head bytes
RecordHead to_head(std::string_view bytes);

std::optional<Header> to_header(std::string_view content);
std::optional<Footer> to_footer(std::string_view content);
std::optional<Schema> to_schema(std::string_view content);
std::optional<Channel> to_channel(std::string_view content);
/// Refers to the content.
std::optional<Message> to_message(std::string_view content);

struct Chunk {
  ChunkIndex index;  ///< without offset, length and message indexes
  std::uint32_t crc = 0;
  std::string_view records;  ///< compressed; refers to the content
};
std::optional<Chunk> to_chunk(std::string_view content);

/// Time and offset of a channel's messages in a chunk.
struct MessageIndex {
  std::uint16_t channel = 0;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> entries;
};
std::optional<MessageIndex> to_message_index(std::string_view content);
std::optional<ChunkIndex> to_chunk_index(std::string_view content);

struct Attachment {
  AttachmentIndex index;   ///< without offset and length
  std::string_view data;   ///< refers to the content
  bool is_intact = false;  ///< its CRC is right, or was not computed
};
std::optional<Attachment> to_attachment(std::string_view content);
std::optional<AttachmentIndex> to_attachment_index(std::string_view content);

struct Metadata {
  std::string name;
  Map values;
};
std::optional<Metadata> to_metadata(std::string_view content);
std::optional<MetadataIndex> to_metadata_index(std::string_view content);
std::optional<Statistics> to_statistics(std::string_view content);
/// The CRC of the data section; 0: not computed.
std::optional<std::uint32_t> to_data_end(std::string_view content);

}  // namespace ziggurat::mcap
