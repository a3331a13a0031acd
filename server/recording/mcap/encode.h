// SPDX-License-Identifier: MIT
#pragma once
// Records as bytes, each with its head.

#include <string>
#include <string_view>

#include "recording/mcap/records.h"

namespace ziggurat::mcap {

void append(const Header& header, std::string& to);
/// Without the CRC, which covers what is written before it.
void append_without_crc(const Footer& footer, std::string& to);
void append(const Schema& schema, std::string& to);
void append(const Channel& channel, std::string& to);
void append(const Message& message, std::string& to);
/// @param records  compressed
void append_chunk(const ChunkIndex& index, std::uint32_t crc, std::string_view records,
                  std::string& to);
void append_message_index(std::uint16_t channel,
                          const std::vector<std::pair<std::uint64_t, std::uint64_t>>& entries,
                          std::string& to);
void append(const ChunkIndex& index, std::string& to);
void append_attachment(const AttachmentIndex& index, std::string_view data, std::string& to);
void append(const AttachmentIndex& index, std::string& to);
void append_metadata(std::string_view name, const Map& metadata, std::string& to);
void append(const MetadataIndex& index, std::string& to);
void append(const Statistics& statistics, std::string& to);
void append_summary_offset(Op group, std::uint64_t start, std::uint64_t length, std::string& to);
void append_data_end(std::uint32_t crc, std::string& to);

}  // namespace ziggurat::mcap
