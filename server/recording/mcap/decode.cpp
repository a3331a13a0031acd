// SPDX-License-Identifier: MIT
#include "recording/mcap/decode.h"

#include "recording/mcap/bytes.h"

namespace ziggurat::mcap {
namespace {

/// Records may grow at their ends in later versions: what is left over is ignored.
template <class Record>
std::optional<Record> if_ok(const Bytes& bytes, Record record) {
  if (!bytes.ok()) return std::nullopt;
  return record;
}

std::string text(Bytes& bytes) { return std::string(bytes.text()); }

/// False if the map does not fill its length.
bool read_map(Bytes& from, Map& to) {
  Bytes bytes(from.text());
  while (bytes.ok() && bytes.left() > 0) {
    std::string name = text(bytes);
    to.emplace_back(std::move(name), text(bytes));
  }
  return bytes.ok();
}

template <class First>
bool read_pairs(Bytes& from, std::vector<std::pair<First, std::uint64_t>>& to) {
  Bytes bytes(from.text());
  to.reserve(bytes.left() / (sizeof(First) + 8));
  while (bytes.ok() && bytes.left() > 0) {
    const auto first = bytes.number<First>();
    to.emplace_back(first, bytes.number<std::uint64_t>());
  }
  return bytes.ok();
}

}  // namespace

RecordHead to_head(std::string_view from) {
  Bytes bytes(from);
  RecordHead head;
  head.op = bytes.number<std::uint8_t>();
  head.length = bytes.number<std::uint64_t>();
  return head;
}

std::optional<Header> to_header(std::string_view content) {
  Bytes bytes(content);
  Header header;
  header.profile = text(bytes);
  header.writer = text(bytes);
  return if_ok(bytes, std::move(header));
}

std::optional<Footer> to_footer(std::string_view content) {
  Bytes bytes(content);
  Footer footer;
  footer.summary_start = bytes.number<std::uint64_t>();
  footer.summary_offset_start = bytes.number<std::uint64_t>();
  footer.summary_crc = bytes.number<std::uint32_t>();
  return if_ok(bytes, footer);
}

std::optional<Schema> to_schema(std::string_view content) {
  Bytes bytes(content);
  Schema schema;
  schema.id = bytes.number<std::uint16_t>();
  schema.name = text(bytes);
  schema.encoding = text(bytes);
  schema.data = text(bytes);
  if (schema.id == 0) return std::nullopt;
  return if_ok(bytes, std::move(schema));
}

std::optional<Channel> to_channel(std::string_view content) {
  Bytes bytes(content);
  Channel channel;
  channel.id = bytes.number<std::uint16_t>();
  channel.schema = bytes.number<std::uint16_t>();
  channel.topic = text(bytes);
  channel.encoding = text(bytes);
  if (!read_map(bytes, channel.metadata)) return std::nullopt;
  return if_ok(bytes, std::move(channel));
}

std::optional<Message> to_message(std::string_view content) {
  Bytes bytes(content);
  Message message;
  message.channel = bytes.number<std::uint16_t>();
  message.sequence = bytes.number<std::uint32_t>();
  message.log_time = bytes.number<std::uint64_t>();
  message.publish_time = bytes.number<std::uint64_t>();
  message.data = bytes.rest();
  return if_ok(bytes, message);
}

std::optional<Chunk> to_chunk(std::string_view content) {
  Bytes bytes(content);
  Chunk chunk;
  chunk.index.start_time = bytes.number<std::uint64_t>();
  chunk.index.end_time = bytes.number<std::uint64_t>();
  chunk.index.uncompressed_size = bytes.number<std::uint64_t>();
  chunk.crc = bytes.number<std::uint32_t>();
  chunk.index.compression = text(bytes);
  chunk.records = bytes.long_text();
  chunk.index.compressed_size = chunk.records.size();
  return if_ok(bytes, std::move(chunk));
}

std::optional<MessageIndex> to_message_index(std::string_view content) {
  Bytes bytes(content);
  MessageIndex index;
  index.channel = bytes.number<std::uint16_t>();
  if (!read_pairs(bytes, index.entries)) return std::nullopt;
  return if_ok(bytes, std::move(index));
}

std::optional<ChunkIndex> to_chunk_index(std::string_view content) {
  Bytes bytes(content);
  ChunkIndex index;
  index.start_time = bytes.number<std::uint64_t>();
  index.end_time = bytes.number<std::uint64_t>();
  index.offset = bytes.number<std::uint64_t>();
  index.length = bytes.number<std::uint64_t>();
  if (!read_pairs(bytes, index.message_index_offsets)) return std::nullopt;
  index.message_index_length = bytes.number<std::uint64_t>();
  index.compression = text(bytes);
  index.compressed_size = bytes.number<std::uint64_t>();
  index.uncompressed_size = bytes.number<std::uint64_t>();
  return if_ok(bytes, std::move(index));
}

std::optional<Attachment> to_attachment(std::string_view content) {
  Bytes bytes(content);
  Attachment attachment;
  attachment.index.log_time = bytes.number<std::uint64_t>();
  attachment.index.create_time = bytes.number<std::uint64_t>();
  attachment.index.name = text(bytes);
  attachment.index.media_type = text(bytes);
  attachment.data = bytes.long_text();
  attachment.index.data_size = attachment.data.size();
  const std::size_t covered = content.size() - bytes.left();
  const auto crc = bytes.number<std::uint32_t>();
  attachment.is_intact = crc == 0 || crc == crc32(content.substr(0, covered));
  return if_ok(bytes, std::move(attachment));
}

std::optional<AttachmentIndex> to_attachment_index(std::string_view content) {
  Bytes bytes(content);
  AttachmentIndex index;
  index.offset = bytes.number<std::uint64_t>();
  index.length = bytes.number<std::uint64_t>();
  index.log_time = bytes.number<std::uint64_t>();
  index.create_time = bytes.number<std::uint64_t>();
  index.data_size = bytes.number<std::uint64_t>();
  index.name = text(bytes);
  index.media_type = text(bytes);
  return if_ok(bytes, std::move(index));
}

std::optional<Metadata> to_metadata(std::string_view content) {
  Bytes bytes(content);
  Metadata metadata;
  metadata.name = text(bytes);
  if (!read_map(bytes, metadata.values)) return std::nullopt;
  return if_ok(bytes, std::move(metadata));
}

std::optional<MetadataIndex> to_metadata_index(std::string_view content) {
  Bytes bytes(content);
  MetadataIndex index;
  index.offset = bytes.number<std::uint64_t>();
  index.length = bytes.number<std::uint64_t>();
  index.name = text(bytes);
  return if_ok(bytes, std::move(index));
}

std::optional<Statistics> to_statistics(std::string_view content) {
  Bytes bytes(content);
  Statistics statistics;
  statistics.messages = bytes.number<std::uint64_t>();
  statistics.schemas = bytes.number<std::uint16_t>();
  statistics.channels = bytes.number<std::uint32_t>();
  statistics.attachments = bytes.number<std::uint32_t>();
  statistics.metadata = bytes.number<std::uint32_t>();
  statistics.chunks = bytes.number<std::uint32_t>();
  statistics.start_time = bytes.number<std::uint64_t>();
  statistics.end_time = bytes.number<std::uint64_t>();
  if (!read_pairs(bytes, statistics.channel_messages)) return std::nullopt;
  return if_ok(bytes, std::move(statistics));
}

std::optional<std::uint32_t> to_data_end(std::string_view content) {
  Bytes bytes(content);
  const auto crc = bytes.number<std::uint32_t>();
  return if_ok(bytes, crc);
}

}  // namespace ziggurat::mcap
