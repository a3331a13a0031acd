// SPDX-License-Identifier: MIT
#include "recording/mcap/writer.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "recording/mcap/bytes.h"
#include "recording/mcap/encode.h"

namespace ziggurat::mcap {

Writer::Writer(Sink sink, const Header& header, Compression compression, MessageIndexes indexes)
    : sink_(std::move(sink)), compressor_(compression), indexes_(indexes), states_(1) {
  std::string bytes(magic);
  append(header, bytes);
  give(bytes);
}

void Writer::give(std::string_view bytes) {
  sink_(bytes);
  size_ += bytes.size();
  crc_ = crc32(bytes, crc_);
}

/// Definitions stand outside of chunks: a damaged chunk takes none of them along.
std::uint16_t Writer::add_schema(std::string_view name, std::string_view encoding,
                                 std::string_view data) {
  if (schema_count_ == std::numeric_limits<std::uint16_t>::max()) {
    throw std::length_error("an MCAP file has at most 65535 schemas");
  }
  record_.clear();
  append(Schema{++schema_count_, std::string(name), std::string(encoding), std::string(data)},
         record_);
  schemas_ += record_;
  give(record_);
  return schema_count_;
}

std::uint16_t Writer::add_channel(std::uint16_t schema, std::string_view topic,
                                  std::string_view encoding, const Map& metadata) {
  if (channel_count_ == std::numeric_limits<std::uint16_t>::max()) {
    throw std::length_error("an MCAP file has at most 65535 channels");
  }
  record_.clear();
  append(Channel{++channel_count_, schema, std::string(topic), std::string(encoding), metadata},
         record_);
  channels_ += record_;
  states_.emplace_back();
  give(record_);
  return channel_count_;
}

void Writer::write(std::uint16_t channel, std::uint64_t log_time, std::uint64_t publish_time,
                   std::string_view data) {
  write({channel, states_.at(channel).next_sequence, log_time, publish_time, data});
}

void Writer::write(const Message& message) {
  ChannelState& state = states_.at(message.channel);
  state.next_sequence = message.sequence + 1;
  if (state.index.empty()) used_.push_back(message.channel);
  if (chunk_.empty()) {
    chunk_start_ = chunk_end_ = message.log_time;
  } else {
    chunk_start_ = std::min(chunk_start_, message.log_time);
    chunk_end_ = std::max(chunk_end_, message.log_time);
  }
  state.index.emplace_back(message.log_time, chunk_.size());
  append(message, chunk_);
}

void Writer::end_chunk() {
  if (chunk_.empty()) return;
  ChunkIndex index;
  index.start_time = chunk_start_;
  index.end_time = chunk_end_;
  index.offset = size_;
  index.compression = name_of(compressor_.compression());
  index.uncompressed_size = chunk_.size();
  const std::string_view compressed = compressor_.compress(chunk_);
  index.compressed_size = compressed.size();
  record_.clear();
  append_chunk(index, crc32(chunk_), compressed, record_);
  index.length = record_.size();
  write_indexes(index, size_ + record_.size(), record_);
  give(record_);
  chunks_.push_back(std::move(index));
  chunk_.clear();
}

/// The message indexes after a chunk; counts what is in it.
void Writer::write_indexes(ChunkIndex& index, std::uint64_t chunk_end, std::string& to) {
  const bool is_first = statistics_.messages == 0;
  statistics_.start_time = is_first ? chunk_start_ : std::min(statistics_.start_time, chunk_start_);
  statistics_.end_time = is_first ? chunk_end_ : std::max(statistics_.end_time, chunk_end_);
  const std::size_t begin = to.size();
  for (const std::uint16_t channel : used_) {
    ChannelState& state = states_[channel];
    if (indexes_ == MessageIndexes::written) {
      index.message_index_offsets.emplace_back(channel, chunk_end + to.size() - begin);
      std::ranges::stable_sort(state.index, {}, [](const auto& entry) { return entry.first; });
      append_message_index(channel, state.index, to);
    }
    state.messages += state.index.size();
    statistics_.messages += state.index.size();
    state.index.clear();
  }
  index.message_index_length = to.size() - begin;
  used_.clear();
}

void Writer::attach(std::string_view name, std::string_view media_type, std::string_view data,
                    std::uint64_t log_time, std::uint64_t create_time) {
  AttachmentIndex index{
      size_, 0, log_time, create_time, data.size(), std::string(name), std::string(media_type)};
  record_.clear();
  append_attachment(index, data, record_);
  index.length = record_.size();
  give(record_);
  attachments_.push_back(std::move(index));
}

void Writer::add_metadata(std::string_view name, const Map& metadata) {
  record_.clear();
  append_metadata(name, metadata, record_);
  metadata_.push_back({size_, record_.size(), std::string(name)});
  give(record_);
}

void Writer::close() {
  end_chunk();
  std::string bytes;
  append_data_end(crc_, bytes);
  Footer footer;
  footer.summary_start = size_ + bytes.size();
  std::string end = summary(footer.summary_start, footer.summary_offset_start);
  append_without_crc(footer, end);
  put(crc32(end), end);
  end += magic;
  give(bytes + end);
}

/// @param begin  where it will stand
/// @param offsets_begin  is set: where its summary offsets will stand
std::string Writer::summary(std::uint64_t begin, std::uint64_t& offsets_begin) const {
  std::string bytes, offsets;
  const auto add_group = [&](Op op, const auto& add) {
    const std::size_t start = bytes.size();
    add();
    if (bytes.size() > start)
      append_summary_offset(op, begin + start, bytes.size() - start, offsets);
  };
  const auto add_all = [&](const auto& records) {
    return [&] {
      for (const auto& record : records) append(record, bytes);
    };
  };
  Statistics statistics = statistics_;
  statistics.schemas = schema_count_;
  statistics.channels = channel_count_;
  statistics.attachments = static_cast<std::uint32_t>(attachments_.size());
  statistics.metadata = static_cast<std::uint32_t>(metadata_.size());
  statistics.chunks = static_cast<std::uint32_t>(chunks_.size());
  for (std::size_t i = 1; i < states_.size(); ++i) {
    statistics.channel_messages.emplace_back(static_cast<std::uint16_t>(i), states_[i].messages);
  }
  add_group(Op::schema, [&] { bytes += schemas_; });
  add_group(Op::channel, [&] { bytes += channels_; });
  add_group(Op::statistics, [&] { append(statistics, bytes); });
  add_group(Op::chunk_index, add_all(chunks_));
  add_group(Op::attachment_index, add_all(attachments_));
  add_group(Op::metadata_index, add_all(metadata_));
  offsets_begin = begin + bytes.size();
  return bytes + offsets;
}

}  // namespace ziggurat::mcap
