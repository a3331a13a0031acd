// SPDX-License-Identifier: MIT
#pragma once
// Writer of an MCAP file with any content: chunks with message indexes, attachments, metadata, and
// a summary at the end. Records outside of chunks are written at once. So a file that is cut off
// anywhere is good up to its last whole chunk.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "recording/mcap/compression.h"
#include "recording/mcap/records.h"

namespace ziggurat::mcap {

/// Takes the file's bytes, in order: whole records at each call. May throw; then the writer must
/// not be used any more.
using Sink = std::function<void(std::string_view)>;

/// Places of the messages of a chunk, for readers of single channels.
enum class MessageIndexes { written, left_out };

class Writer {
 public:
  /// Writes the magic and the header.
  Writer(Sink sink, const Header& header, Compression compression,
         MessageIndexes indexes = MessageIndexes::written);

  /// @return  its id
  std::uint16_t add_schema(std::string_view name, std::string_view encoding, std::string_view data);
  /// @param schema  0: none
  std::uint16_t add_channel(std::uint16_t schema, std::string_view topic, std::string_view encoding,
                            const Map& metadata = {});
  /// Appends to the present chunk. Counts the messages of each channel in `sequence`.
  /// @param channel  of add_channel()
  /// @param log_time, publish_time  [ns]
  void write(std::uint16_t channel, std::uint64_t log_time, std::uint64_t publish_time,
             std::string_view data);
  /// Appends with a sequence number of its own.
  void write(const Message& message);

  /// Size of the current chunk, before compression [bytes].
  std::size_t chunk_size() const { return chunk_.size(); }
  /// Compresses the present chunk and writes it with its indexes; without messages nothing is done.
  void end_chunk();

  /// @param times  log time and creation time [ns]
  void attach(std::string_view name, std::string_view media_type, std::string_view data,
              std::uint64_t log_time, std::uint64_t create_time);
  void add_metadata(std::string_view name, const Map& metadata);

  /// Ends the chunk, writes the summary and the footer.
  void close();

  std::uint64_t size() const { return size_; }             ///< written so far [bytes]
  std::uint64_t chunks() const { return chunks_.size(); }  ///< written so far

 private:
  struct ChannelState {
    std::uint64_t messages = 0;
    std::uint32_t next_sequence = 0;
    std::vector<std::pair<std::uint64_t, std::uint64_t>> index;  // of the chunk: time, offset
  };

  void give(std::string_view bytes);
  void write_indexes(ChunkIndex& index, std::uint64_t chunk_end, std::string& to);
  std::string summary(std::uint64_t begin, std::uint64_t& offsets_begin) const;

  Sink sink_;
  Compressor compressor_;
  MessageIndexes indexes_;
  std::uint64_t size_ = 0;
  std::uint32_t crc_ = 0;           // of all bytes so far
  std::string schemas_, channels_;  // records, for the summary
  std::uint16_t schema_count_ = 0, channel_count_ = 0;
  std::vector<ChannelState> states_;  // by channel id
  std::vector<std::uint16_t>
      used_;  // channels in the present chunk, in the order of their first message
  std::string chunk_, record_;
  std::uint64_t chunk_start_ = 0, chunk_end_ = 0;  // times of its messages [ns]
  Statistics statistics_;
  std::vector<ChunkIndex> chunks_;
  std::vector<AttachmentIndex> attachments_;
  std::vector<MetadataIndex> metadata_;
};

}  // namespace ziggurat::mcap
