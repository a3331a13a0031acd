// SPDX-License-Identifier: MIT
#include "recording/mcap/messages.h"

#include <algorithm>
#include <utility>

namespace ziggurat::mcap {

Messages::Messages(const Reader& reader, Selection selection)
    : reader_(reader), selection_(std::move(selection)) {
  std::ranges::sort(selection_.channels);
}

bool Messages::is_wanted(const ChunkIndex& chunk) const {
  if (chunk.end_time < selection_.from || chunk.start_time > selection_.to) return false;
  if (selection_.channels.empty() || chunk.message_index_offsets.empty()) return true;
  return std::ranges::any_of(chunk.message_index_offsets, [&](const auto& entry) {
    return std::ranges::binary_search(selection_.channels, entry.first);
  });
}

bool Messages::is_wanted(const Message& message) const {
  if (message.log_time < selection_.from || message.log_time > selection_.to) return false;
  return selection_.channels.empty() ||
         std::ranges::binary_search(selection_.channels, message.channel);
}

bool Messages::open_next_chunk() {
  const auto& chunks = reader_.contents().chunks;
  at_ = 0;
  records_.clear();
  while (next_chunk_ < chunks.size() && !is_wanted(chunks[next_chunk_])) ++next_chunk_;
  if (next_chunk_ == chunks.size()) return false;
  records_ = reader_.chunk(chunks[next_chunk_++]);  // counted first: it may throw
  return true;
}

std::optional<Message> Messages::next() {
  for (;;) {
    if (at_ == records_.size() && !open_next_chunk()) return std::nullopt;
    if (at_ == records_.size()) continue;  // a chunk without records
    const std::string_view left = std::string_view(records_).substr(at_);
    const std::uint64_t offset = reader_.contents().chunks[next_chunk_ - 1].offset;
    const auto damaged = [&] {
      at_ = records_.size();
      return Damaged(offset, "the chunk is damaged");
    };
    if (left.size() < record_head) throw damaged();
    const RecordHead head = to_head(left.substr(0, record_head));
    if (head.length > left.size() - record_head) throw damaged();
    const auto length = static_cast<std::size_t>(head.length);
    at_ += record_head + length;
    if (!head.is(Op::message)) continue;
    const auto message = to_message(left.substr(record_head, length));
    if (!message) throw damaged();
    if (is_wanted(*message)) return message;
  }
}

}  // namespace ziggurat::mcap
