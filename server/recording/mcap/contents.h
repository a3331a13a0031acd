// SPDX-License-Identifier: MIT
#pragma once
// Contents of an MCAP file, without messages and the data of attachments.

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "recording/mcap/records.h"

namespace ziggurat::mcap {

/// The most memory that a file may ask a reader for [bytes].
struct Limits {
  std::size_t chunk = std::size_t{256} << 20;       ///< compressed, and decompressed
  std::size_t attachment = std::size_t{512} << 20;  ///< one
  std::size_t record = std::size_t{16} << 20;       ///< any other one
  std::size_t index = std::size_t{64}
                      << 20;  ///< the summary; all schemas and channels; all indexes
};

/// A damaged place of a file.
struct Fault {
  std::uint64_t offset = 0;  ///< from the start of the file
  std::string text;          ///< a sentence without a full stop
};
inline constexpr std::size_t most_faults = 100;  ///< that are kept of a file

struct Contents {
  Header header;
  std::map<std::uint16_t, Schema> schemas;    // by id
  std::map<std::uint16_t, Channel> channels;  // by id
  std::vector<ChunkIndex> chunks;             // in the order of the file
  std::vector<AttachmentIndex> attachments;
  std::vector<MetadataIndex> metadata;
  Statistics statistics;

  /// The channel with this topic; null: there is none.
  const Channel* channel_of(std::string_view topic) const {
    for (const auto& [id, channel] : channels) {
      if (channel.topic == topic) return &channel;
    }
    return nullptr;
  }
  /// Number of messages of a channel; 0 if the statistics leave it out.
  std::uint64_t messages_of(std::uint16_t channel) const {
    for (const auto& [id, count] : statistics.channel_messages) {
      if (id == channel) return count;
    }
    return 0;
  }
};

}  // namespace ziggurat::mcap
