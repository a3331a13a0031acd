// SPDX-License-Identifier: MIT
#pragma once
// The records of an MCAP file (version 0), as plain data. Integers are little-endian in the file.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ziggurat::mcap {

/// The first and the last 8 bytes of a file.
inline constexpr std::string_view magic{"\x89MCAP0\r\n", 8};

enum class Op : std::uint8_t {
  header = 0x01,
  footer,
  schema,
  channel,
  message,
  chunk,
  message_index,
  chunk_index,
  attachment,
  attachment_index,
  statistics,
  metadata,
  metadata_index,
  summary_offset,
  data_end,
};

/// The op code and the length of the content that follows [bytes].
inline constexpr std::size_t record_head = 9;
/// A footer with its head and the magic after it.
inline constexpr std::size_t end_size = record_head + 20 + 8;

enum class Compression { none, lz4, zstd };

using Map = std::vector<std::pair<std::string, std::string>>;

struct Header {
  std::string profile;
  std::string writer;  ///< program that wrote the file: `library` in the specification
};

struct Footer {
  std::uint64_t summary_start = 0;         ///< offset; 0: there is no summary
  std::uint64_t summary_offset_start = 0;  ///< offset; 0: there are no summary offsets
  std::uint32_t summary_crc = 0;           ///< 0: not computed
};

struct Schema {
  std::uint16_t id = 0;  ///< from 1 on
  std::string name, encoding, data;
  bool operator==(const Schema&) const = default;
};

struct Channel {
  std::uint16_t id = 0;
  std::uint16_t schema = 0;  ///< 0: none
  std::string topic, encoding;
  Map metadata;
  bool operator==(const Channel&) const = default;
};

struct Message {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0, publish_time = 0;  ///< [ns]
  std::string_view data;
};

/// Offset and content of a chunk.
struct ChunkIndex {
  std::uint64_t start_time = 0, end_time = 0;  ///< of its messages, both included [ns]
  std::uint64_t offset = 0, length = 0;        ///< of the record with its head
  std::vector<std::pair<std::uint16_t, std::uint64_t>> message_index_offsets;  ///< by channel
  std::uint64_t message_index_length = 0;  ///< of all message indexes after it [bytes]
  std::string compression;                 ///< as in the file
  std::uint64_t compressed_size = 0, uncompressed_size = 0;  ///< [bytes]
};

struct AttachmentIndex {
  std::uint64_t offset = 0, length = 0;         ///< of the record with its head
  std::uint64_t log_time = 0, create_time = 0;  ///< [ns]
  std::uint64_t data_size = 0;                  ///< [bytes]
  std::string name, media_type;
};

struct MetadataIndex {
  std::uint64_t offset = 0, length = 0;  ///< of the record with its head
  std::string name;
};

struct Statistics {
  std::uint64_t messages = 0;
  std::uint16_t schemas = 0;
  std::uint32_t channels = 0, attachments = 0, metadata = 0, chunks = 0;
  std::uint64_t start_time = 0, end_time = 0;                             ///< of all messages [ns]
  std::vector<std::pair<std::uint16_t, std::uint64_t>> channel_messages;  ///< number by channel
  bool operator==(const Statistics&) const = default;
};

/// As the file names it: empty for none.
std::string_view name_of(Compression compression);

}  // namespace ziggurat::mcap
