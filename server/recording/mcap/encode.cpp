// SPDX-License-Identifier: MIT
#include "recording/mcap/encode.h"

#include "recording/mcap/bytes.h"

namespace ziggurat::mcap {
namespace {

/// A record that is being appended: its length is set at the end.
class Record {
 public:
  Record(Op op, std::string& to) : to_(to), begin_(to.size()) {
    to_.push_back(static_cast<char>(op));
    put(std::uint64_t{0}, to_);
  }
  ~Record() {
    const std::uint64_t length = to_.size() - begin_ - record_head;
    for (std::size_t i = 0; i < 8; ++i) to_[begin_ + 1 + i] = static_cast<char>(length >> (8 * i));
  }
  Record(const Record&) = delete;
  Record& operator=(const Record&) = delete;

 private:
  std::string& to_;
  const std::size_t begin_;
};

void put_map(const Map& map, std::string& to) {
  std::size_t size = 0;
  for (const auto& [name, value] : map) size += 8 + name.size() + value.size();
  put(static_cast<std::uint32_t>(size), to);
  for (const auto& [name, value] : map) {
    put_text(name, to);
    put_text(value, to);
  }
}

void put_counts(const std::vector<std::pair<std::uint16_t, std::uint64_t>>& counts,
                std::string& to) {
  put(static_cast<std::uint32_t>(10 * counts.size()), to);
  for (const auto& [channel, count] : counts) {
    put(channel, to);
    put(count, to);
  }
}

}  // namespace

void append(const Header& header, std::string& to) {
  const Record record(Op::header, to);
  put_text(header.profile, to);
  put_text(header.writer, to);
}

void append_without_crc(const Footer& footer, std::string& to) {
  to.push_back(static_cast<char>(Op::footer));
  put(std::uint64_t{20}, to);
  put(footer.summary_start, to);
  put(footer.summary_offset_start, to);
}

void append(const Schema& schema, std::string& to) {
  const Record record(Op::schema, to);
  put(schema.id, to);
  put_text(schema.name, to);
  put_text(schema.encoding, to);
  put_text(schema.data, to);
}

void append(const Channel& channel, std::string& to) {
  const Record record(Op::channel, to);
  put(channel.id, to);
  put(channel.schema, to);
  put_text(channel.topic, to);
  put_text(channel.encoding, to);
  put_map(channel.metadata, to);
}

void append(const Message& message, std::string& to) {
  const Record record(Op::message, to);
  put(message.channel, to);
  put(message.sequence, to);
  put(message.log_time, to);
  put(message.publish_time, to);
  to += message.data;
}

void append_chunk(const ChunkIndex& index, std::uint32_t crc, std::string_view records,
                  std::string& to) {
  const Record record(Op::chunk, to);
  put(index.start_time, to);
  put(index.end_time, to);
  put(index.uncompressed_size, to);
  put(crc, to);
  put_text(index.compression, to);
  put(std::uint64_t{records.size()}, to);
  to += records;
}

void append_message_index(std::uint16_t channel,
                          const std::vector<std::pair<std::uint64_t, std::uint64_t>>& entries,
                          std::string& to) {
  const Record record(Op::message_index, to);
  put(channel, to);
  put(static_cast<std::uint32_t>(16 * entries.size()), to);
  for (const auto& [time, offset] : entries) {
    put(time, to);
    put(offset, to);
  }
}

void append(const ChunkIndex& index, std::string& to) {
  const Record record(Op::chunk_index, to);
  put(index.start_time, to);
  put(index.end_time, to);
  put(index.offset, to);
  put(index.length, to);
  put_counts(index.message_index_offsets, to);
  put(index.message_index_length, to);
  put_text(index.compression, to);
  put(index.compressed_size, to);
  put(index.uncompressed_size, to);
}

void append_attachment(const AttachmentIndex& index, std::string_view data, std::string& to) {
  const Record record(Op::attachment, to);
  const std::size_t begin = to.size();
  put(index.log_time, to);
  put(index.create_time, to);
  put_text(index.name, to);
  put_text(index.media_type, to);
  put(std::uint64_t{data.size()}, to);
  to += data;
  put(crc32(std::string_view(to).substr(begin)), to);
}

void append(const AttachmentIndex& index, std::string& to) {
  const Record record(Op::attachment_index, to);
  put(index.offset, to);
  put(index.length, to);
  put(index.log_time, to);
  put(index.create_time, to);
  put(index.data_size, to);
  put_text(index.name, to);
  put_text(index.media_type, to);
}

void append_metadata(std::string_view name, const Map& metadata, std::string& to) {
  const Record record(Op::metadata, to);
  put_text(name, to);
  put_map(metadata, to);
}

void append(const MetadataIndex& index, std::string& to) {
  const Record record(Op::metadata_index, to);
  put(index.offset, to);
  put(index.length, to);
  put_text(index.name, to);
}

void append(const Statistics& statistics, std::string& to) {
  const Record record(Op::statistics, to);
  put(statistics.messages, to);
  put(statistics.schemas, to);
  put(statistics.channels, to);
  put(statistics.attachments, to);
  put(statistics.metadata, to);
  put(statistics.chunks, to);
  put(statistics.start_time, to);
  put(statistics.end_time, to);
  put_counts(statistics.channel_messages, to);
}

void append_summary_offset(Op group, std::uint64_t start, std::uint64_t length, std::string& to) {
  const Record record(Op::summary_offset, to);
  to.push_back(static_cast<char>(group));
  put(start, to);
  put(length, to);
}

void append_data_end(std::uint32_t crc, std::string& to) {
  const Record record(Op::data_end, to);
  put(crc, to);
}

}  // namespace ziggurat::mcap
