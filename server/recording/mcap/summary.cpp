// SPDX-License-Identifier: MIT
#include "recording/mcap/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "recording/mcap/bytes.h"
#include "recording/mcap/decode.h"

namespace ziggurat::mcap {
namespace {

/// Adds what is in a record of the summary. False: the record is not what its op code says.
bool add(const RecordHead& head, std::string_view content, Contents& to) {
  const auto into = [](auto record, auto& list) {
    if (record) list.push_back(*std::move(record));
    return record.has_value();
  };
  const auto by_id = [](auto record, auto& map) {
    if (record) map.insert_or_assign(record->id, *record);
    return record.has_value();
  };
  switch (static_cast<Op>(head.op)) {
    case Op::schema:
      return by_id(to_schema(content), to.schemas);
    case Op::channel:
      return by_id(to_channel(content), to.channels);
    case Op::chunk_index:
      return into(to_chunk_index(content), to.chunks);
    case Op::attachment_index:
      return into(to_attachment_index(content), to.attachments);
    case Op::metadata_index:
      return into(to_metadata_index(content), to.metadata);
    case Op::statistics: {
      auto statistics = to_statistics(content);
      if (statistics) to.statistics = *std::move(statistics);
      return statistics.has_value();
    }
    default:
      return true;  // summary offsets, and what later versions may add
  }
}

Footer read_footer(const Source& source) {
  if (source.size < magic.size() + end_size) throw Damaged(source.size, "the file is cut off");
  const std::uint64_t begin = source.size - end_size;
  std::string bytes;
  source.read(begin, end_size, bytes);
  if (!bytes.ends_with(magic)) {
    throw Damaged(
        source.size - magic.size(),
        "the file has no end: the program that wrote it did not complete it, or it is cut "
        "off or damaged there");
  }
  const RecordHead head = to_head(bytes);
  const auto footer = to_footer(std::string_view(bytes).substr(record_head, 20));
  if (!head.is(Op::footer) || head.length != 20 || !footer) {
    throw Damaged(begin, "the footer is damaged");
  }
  return *footer;
}

/// A small file whose summary lists one chunk again and again would be read without end.
/// @throws Damaged if it lists a place of the file twice
void check_places(const Summary& summary) {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> places;  // offset and length
  const auto add_all = [&](const auto& list) {
    for (const auto& index : list) places.emplace_back(index.offset, index.length);
  };
  add_all(summary.contents.chunks);
  add_all(summary.contents.attachments);
  add_all(summary.contents.metadata);
  std::ranges::sort(places);
  const auto overlap = [](const auto& a, const auto& b) { return b.first - a.first < a.second; };
  if (std::ranges::adjacent_find(places, overlap) != places.end()) {
    throw Damaged(summary.start, "the summary is damaged: it lists a place of the file twice");
  }
}

}  // namespace

Summary read_summary(const Source& source, const Limits& limits) {
  const Footer footer = read_footer(source);
  const std::uint64_t end = source.size - end_size;
  if (footer.summary_start == 0) throw Damaged(end, "the file has no summary");
  if (footer.summary_start < magic.size() || footer.summary_start > end) {
    throw Damaged(end, "the footer is damaged: the summary begins outside of the file");
  }
  if (end - footer.summary_start > limits.index) {
    throw Damaged(footer.summary_start, fmt::format("the summary has {} bytes; at most {} are read",
                                                    end - footer.summary_start, limits.index));
  }
  std::string bytes;
  constexpr std::size_t covered = record_head + 16;  // of the footer, by the CRC
  source.read(footer.summary_start, static_cast<std::size_t>(end - footer.summary_start) + covered,
              bytes);
  if (footer.summary_crc != 0 && crc32(bytes) != footer.summary_crc) {
    throw Damaged(footer.summary_start, "the summary is damaged: its CRC is wrong");
  }
  Summary summary{footer.summary_start, {}};
  const std::string_view records = std::string_view(bytes).substr(0, bytes.size() - covered);
  for (std::size_t at = 0; at < records.size();) {
    const std::uint64_t offset = footer.summary_start + at;
    if (records.size() - at < record_head) throw Damaged(offset, "the summary is damaged");
    const RecordHead head = to_head(records.substr(at, record_head));
    at += record_head;
    if (head.length > records.size() - at ||
        !add(head, records.substr(at, static_cast<std::size_t>(head.length)), summary.contents)) {
      throw Damaged(offset, "the summary is damaged");
    }
    at += static_cast<std::size_t>(head.length);
  }
  check_places(summary);
  return summary;
}

}  // namespace ziggurat::mcap
