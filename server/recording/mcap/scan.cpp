// SPDX-License-Identifier: MIT
#include "recording/mcap/scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "recording/mcap/bytes.h"
#include "recording/mcap/compression.h"
#include "recording/mcap/decode.h"
#include "recording/mcap/summary.h"

namespace ziggurat::mcap {
namespace {

constexpr std::size_t block = std::size_t{1} << 20;  // what is read of a skipped record at once

/// A message of the last chunk, as its index must list it.
struct Entry {
  std::uint16_t channel;
  std::uint64_t time, offset;
  auto operator<=>(const Entry&) const = default;
};

class Scanner {
 public:
  Scanner(const Source& source, const Limits& limits) : source_(source), limits_(limits) {}

  Scan run();

 private:
  bool next();
  void take(const RecordHead& head);
  bool read_content(const RecordHead& head, std::size_t most);
  void add_chunk(std::string_view content);
  void add_records(std::string_view records, ChunkIndex& index);
  void add_index(std::string_view content);
  void end_indexes();
  void add_attachment(std::string_view content);
  void add_metadata(std::string_view content);
  void end_data(std::string_view content);
  template <class Definition>
  void define(std::optional<Definition> made, std::size_t size,
              std::map<std::uint16_t, Definition>& all, const char* what);
  bool has_room(std::size_t size);
  void fault(std::string text) {
    if (scan_.faults.size() < most_faults) scan_.faults.push_back({offset_, std::move(text)});
  }

  const Source& source_;
  const Limits& limits_;
  Scan scan_;
  std::uint64_t offset_ = 0, length_ = 0;  // of the present record, with its head
  std::uint32_t crc_ = 0;                  // of all before it
  std::string record_;
  std::size_t index_size_ = 0;                     // of all definitions and indexes, about [bytes]
  std::map<std::uint16_t, std::uint64_t> counts_;  // of messages by channel
  std::vector<Entry> entries_;                     // messages of the last chunk, sorted
  std::set<std::uint16_t> listed_;                 // its channels that have a message index
  bool has_index_ = false;                         // message indexes follow the last chunk
  bool is_last_intact_ = false;                    // the last chunk
  bool is_full_ = false;
};

Scan Scanner::run() {
  source_.read(0, magic.size(), record_);
  crc_ = crc32(record_);
  offset_ = magic.size();
  while (!scan_.has_end && next()) {
  }
  end_indexes();
  Statistics& statistics = scan_.contents.statistics;
  statistics.schemas = static_cast<std::uint16_t>(scan_.contents.schemas.size());
  statistics.channels = static_cast<std::uint32_t>(scan_.contents.channels.size());
  statistics.attachments = static_cast<std::uint32_t>(scan_.contents.attachments.size());
  statistics.metadata = static_cast<std::uint32_t>(scan_.contents.metadata.size());
  statistics.chunks = static_cast<std::uint32_t>(scan_.contents.chunks.size());
  statistics.channel_messages.assign(counts_.begin(), counts_.end());
  return std::move(scan_);
}

/// One record. False: there is none, or none can follow.
bool Scanner::next() {
  if (source_.size - offset_ < record_head) {
    fault(offset_ == source_.size ? "the file has no end" : "the file is cut off in a record");
    return false;
  }
  record_.clear();
  source_.read(offset_, record_head, record_);
  const RecordHead head = to_head(record_);
  if (head.length > source_.size - offset_ - record_head) {
    fault("the file is cut off in a record, or the record's length is damaged");
    return false;
  }
  length_ = record_head + head.length;
  take(head);
  if (scan_.has_end || is_full_) return false;
  offset_ += length_;
  return true;
}

/// Reads the content behind the head, or skips it if it is too large.
bool Scanner::read_content(const RecordHead& head, std::size_t most) {
  const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(head.length, most));
  if (size == head.length) {
    source_.read(offset_ + record_head, size, record_);
    if (!head.is(Op::data_end)) crc_ = crc32(record_, crc_);
    return true;
  }
  crc_ = crc32(record_, crc_);
  for (std::uint64_t at = 0; at < head.length; at += block) {
    record_.clear();
    source_.read(offset_ + record_head + at,
                 static_cast<std::size_t>(std::min<std::uint64_t>(block, head.length - at)),
                 record_);
    crc_ = crc32(record_, crc_);
  }
  return false;
}

void Scanner::take(const RecordHead& head) {
  const bool is_chunk = head.is(Op::chunk), is_attachment = head.is(Op::attachment);
  const std::size_t most = is_chunk        ? limits_.chunk
                           : is_attachment ? limits_.attachment
                                           : std::max(limits_.record, limits_.index);
  const bool is_known = head.op >= 1 && head.op <= static_cast<std::uint8_t>(Op::data_end);
  if (!read_content(head, is_known ? most : 0)) {
    if (is_known)
      fault(fmt::format("the record has {} bytes; at most {} are read", head.length, most));
    return;
  }
  if (!is_known) return;  // without content
  const std::string_view content = std::string_view(record_).substr(record_head);
  if (!head.is(Op::message_index)) end_indexes();
  switch (static_cast<Op>(head.op)) {
    case Op::header:
      if (offset_ != magic.size()) fault("there is a second header");
      return;
    case Op::schema:
      return define(to_schema(content), content.size(), scan_.contents.schemas, "schema");
    case Op::channel:
      return define(to_channel(content), content.size(), scan_.contents.channels, "channel");
    case Op::chunk:
      return add_chunk(content);
    case Op::message_index:
      return add_index(content);
    case Op::attachment:
      return add_attachment(content);
    case Op::metadata:
      return add_metadata(content);
    case Op::data_end:
      return end_data(content);
    case Op::message:
      return fault("a message stands outside of the chunks and is not read");
    default:
      return fault(
          fmt::format("a record with the op code 0x{:02x} must stand in the summary", head.op));
  }
}

/// Whether this much more may be kept of the file.
bool Scanner::has_room(std::size_t size) {
  index_size_ += size + 64;
  if (index_size_ <= limits_.index) return true;
  if (!is_full_) {
    fault(fmt::format("schemas, channels and indexes have more than {} bytes; the rest is not read",
                      limits_.index));
  }
  is_full_ = true;
  return false;
}

/// @param size  of its record [bytes]
template <class Definition>
void Scanner::define(std::optional<Definition> made, std::size_t size,
                     std::map<std::uint16_t, Definition>& all, const char* what) {
  if (!made) return fault(fmt::format("a {} is damaged", what));
  const auto known = all.find(made->id);
  if (known != all.end()) {
    if (known->second != *made) fault(fmt::format("{} {} is defined twice", what, made->id));
  } else if (has_room(size)) {
    all.emplace(made->id, *std::move(made));
  }
}

void Scanner::add_chunk(std::string_view content) {
  is_last_intact_ = false;
  try {
    OpenedChunk chunk = open_chunk(content, offset_, limits_);
    chunk.index.offset = offset_;
    chunk.index.length = length_;
    add_records(chunk.records, chunk.index);
    if (!has_room(sizeof(ChunkIndex))) return;
    scan_.contents.chunks.push_back(std::move(chunk.index));
    is_last_intact_ = true;
  } catch (const Damaged& damaged) {
    entries_.clear();
    ++scan_.damaged_chunks;
    fault(damaged.what());
  }
}

/// @throws Damaged
void Scanner::add_records(std::string_view records, ChunkIndex& index) {
  std::uint64_t first = std::numeric_limits<std::uint64_t>::max(), last = 0;
  for (std::size_t at = 0; at < records.size();) {
    if (records.size() - at < record_head) throw Damaged(offset_, "the chunk is damaged");
    const RecordHead head = to_head(records.substr(at, record_head));
    const std::size_t begin = at;
    at += record_head;
    if (head.length > records.size() - at) throw Damaged(offset_, "the chunk is damaged");
    const std::string_view content = records.substr(at, static_cast<std::size_t>(head.length));
    at += content.size();
    if (head.is(Op::schema))
      define(to_schema(content), content.size(), scan_.contents.schemas, "schema");
    if (head.is(Op::channel))
      define(to_channel(content), content.size(), scan_.contents.channels, "channel");
    if (!head.is(Op::message)) continue;
    const auto message = to_message(content);
    if (!message) throw Damaged(offset_, "the chunk is damaged");
    entries_.push_back({message->channel, message->log_time, begin});
    first = std::min(first, message->log_time);
    last = std::max(last, message->log_time);
  }
  if (entries_.empty()) return;
  if (first != index.start_time || last != index.end_time) {
    throw Damaged(offset_, "the chunk is damaged: it says other times than its messages");
  }
  for (const Entry& entry : entries_) {
    const std::uint64_t number = ++counts_[entry.channel];
    if (number == 1 && !scan_.contents.channels.contains(entry.channel)) {
      fault(fmt::format("the channel {} of a message is not defined", entry.channel));
    }
  }
  Statistics& statistics = scan_.contents.statistics;
  statistics.start_time = statistics.messages == 0 ? first : std::min(statistics.start_time, first);
  statistics.end_time = std::max(statistics.end_time, last);
  statistics.messages += entries_.size();
  std::sort(entries_.begin(), entries_.end());
}

void Scanner::add_index(std::string_view content) {
  const auto index = to_message_index(content);
  if (!index) return fault("a message index is damaged");
  if (!is_last_intact_) return;
  has_index_ = true;
  ChunkIndex& chunk = scan_.contents.chunks.back();
  if (!has_room(0)) return;
  if (!index->entries.empty()) chunk.message_index_offsets.emplace_back(index->channel, offset_);
  chunk.message_index_length += length_;
  std::vector<Entry> listed;
  listed.reserve(index->entries.size());
  for (const auto& [time, offset] : index->entries)
    listed.push_back({index->channel, time, offset});
  std::sort(listed.begin(), listed.end());
  const auto begin =
      std::lower_bound(entries_.begin(), entries_.end(), Entry{index->channel, 0, 0});
  const auto end = std::find_if(
      begin, entries_.end(), [&](const Entry& entry) { return entry.channel != index->channel; });
  if (!std::equal(begin, end, listed.begin(), listed.end())) {
    fault("a message index does not list the messages of its chunk");
  }
  if (begin != end) listed_.insert(index->channel);
}

/// State of the last chunk.
void Scanner::end_indexes() {
  std::size_t channels = 0;
  for (std::size_t i = 0; i < entries_.size() && has_index_; ++i) {
    if (i == 0 || entries_[i].channel != entries_[i - 1].channel) ++channels;
  }
  if (has_index_ && channels != listed_.size()) fault("a message index is missing");
  has_index_ = is_last_intact_ = false;
  entries_.clear();
  listed_.clear();
}

void Scanner::add_attachment(std::string_view content) {
  auto attachment = to_attachment(content);
  if (!attachment || !attachment->is_intact)
    return fault("an attachment is damaged: its CRC is wrong");
  attachment->index.offset = offset_;
  attachment->index.length = length_;
  if (!has_room(attachment->index.name.size() + attachment->index.media_type.size())) return;
  scan_.contents.attachments.push_back(std::move(attachment->index));
}

void Scanner::add_metadata(std::string_view content) {
  auto metadata = to_metadata(content);
  if (!metadata) return fault("a metadata record is damaged");
  if (!has_room(metadata->name.size())) return;
  scan_.contents.metadata.push_back({offset_, length_, std::move(metadata->name)});
}

void Scanner::end_data(std::string_view content) {
  scan_.has_end = true;
  scan_.end = offset_ + length_;
  const auto crc = to_data_end(content);
  if (!crc) return fault("the end of the data section is damaged");
  if (*crc != 0 && *crc != crc_) {
    fault("a byte of the data section has changed: its CRC is wrong");
  }
}

void compare(const Scan& scanned, const Summary& summary, std::vector<Fault>& faults) {
  const auto complain = [&](std::string text) {
    faults.push_back({summary.start, std::move(text)});
  };
  if (summary.start != scanned.end) return complain("the summary does not follow the data section");
  const auto place = [](const auto& index) { return std::pair(index.offset, index.length); };
  const auto are_same = [&](const auto& a, const auto& b) {
    return std::ranges::equal(a, b, {}, place, place);
  };
  if (!are_same(scanned.contents.chunks, summary.contents.chunks)) {
    complain("the summary lists other chunks than there are");
  }
  if (!are_same(scanned.contents.attachments, summary.contents.attachments)) {
    complain("the summary lists other attachments than there are");
  }
  if (!are_same(scanned.contents.metadata, summary.contents.metadata)) {
    complain("the summary lists other metadata than there are");
  }
  if (scanned.contents.statistics.messages != summary.contents.statistics.messages) {
    complain(fmt::format("the summary says {} messages; there are {}",
                         summary.contents.statistics.messages,
                         scanned.contents.statistics.messages));
  }
}

}  // namespace

OpenedChunk open_chunk(std::string_view content, std::uint64_t offset, const Limits& limits) {
  auto chunk = to_chunk(content);
  if (!chunk) throw Damaged(offset, "the chunk is damaged");
  if (chunk->index.uncompressed_size > limits.chunk) {
    throw Damaged(offset, fmt::format("the chunk has {} bytes; at most {} are read",
                                      chunk->index.uncompressed_size, limits.chunk));
  }
  OpenedChunk opened{std::move(chunk->index), {}};
  const std::string wrong =
      decompress(opened.index.compression, chunk->records,
                 static_cast<std::size_t>(opened.index.uncompressed_size), opened.records);
  if (!wrong.empty()) throw Damaged(offset, "the chunk " + wrong);
  if (chunk->crc != 0 && crc32(opened.records) != chunk->crc) {
    throw Damaged(offset, "the chunk is damaged: its CRC is wrong");
  }
  return opened;
}

Header read_header(const Source& source, const Limits& limits, std::vector<Fault>& faults) {
  std::string bytes;
  if (source.size < magic.size()) throw Damaged(0, "this is no MCAP file: it is too short");
  source.read(0, magic.size(), bytes);
  if (bytes != magic) throw Damaged(0, "this is no MCAP file: it does not begin as one");
  const auto fail = [&] {
    faults.push_back({magic.size(), "the header is damaged"});
    return Header{};
  };
  if (source.size - magic.size() < record_head) return fail();
  bytes.clear();
  source.read(magic.size(), record_head, bytes);
  const RecordHead head = to_head(bytes);
  const std::uint64_t left = source.size - magic.size() - record_head;
  if (!head.is(Op::header) || head.length > left || head.length > limits.record) return fail();
  bytes.clear();
  source.read(magic.size() + record_head, static_cast<std::size_t>(head.length), bytes);
  auto header = to_header(bytes);
  return header ? *std::move(header) : fail();
}

Scan scan(const Source& source, const Limits& limits) { return Scanner(source, limits).run(); }

Scan check(const Source& source, const Limits& limits) {
  std::vector<Fault> faults;
  Header header = read_header(source, limits, faults);
  Scan scanned = scan(source, limits);
  scanned.contents.header = std::move(header);
  if (scanned.has_end) {
    try {
      compare(scanned, read_summary(source, limits), faults);
    } catch (const Damaged& damaged) {
      faults.push_back({damaged.offset(), damaged.what()});
    }
  }
  scanned.faults.insert(scanned.faults.begin(), faults.begin(), faults.end());
  return scanned;
}

}  // namespace ziggurat::mcap
