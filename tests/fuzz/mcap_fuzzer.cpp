// SPDX-License-Identifier: MIT
// Recordings are files of anyone. Whatever the bytes are: reading them ends, in bounded memory,
// with messages or with the place that is damaged; what a repair saves is a whole file that has
// just the messages that could be read.

#include <cstdint>
#include <string>
#include <string_view>

#include "recording/mcap/messages.h"
#include "recording/mcap/repair.h"
#include "recording/mcap/scan.h"
#include "require.h"

namespace {

using namespace ziggurat;
using fuzz::require;

constexpr mcap::Limits limits{.chunk = std::size_t{1} << 16,
                              .attachment = std::size_t{1} << 16,
                              .record = std::size_t{1} << 16,
                              .index = std::size_t{1} << 16};

/// Reads all messages. Those of channels that are not defined do not count.
std::uint64_t count_messages(const mcap::Reader& reader, const mcap::Selection& selection) {
  mcap::Messages messages(reader, selection);
  std::uint64_t count = 0;
  for (std::size_t damaged = 0; damaged <= reader.contents().chunks.size();) {
    try {
      const auto message = messages.next();
      if (!message) return count;
      require(message->log_time >= selection.from && message->log_time <= selection.to);
      if (reader.contents().channels.contains(message->channel)) ++count;
    } catch (const mcap::Damaged&) {
      ++damaged;
    }
  }
  require(false);  // a chunk was damaged twice
  return count;
}

void read_all(const mcap::Reader& reader) {
  for (const auto& index : reader.contents().attachments) {
    try {
      require(reader.attachment(index).size() <= limits.attachment);
    } catch (const mcap::Damaged&) {
    }
  }
  for (const auto& index : reader.contents().metadata) {
    try {
      reader.metadata(index);
    } catch (const mcap::Damaged&) {
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    const mcap::Reader reader(mcap::bytes_of(bytes), limits);
    if (reader.contents().chunks.size() + reader.contents().attachments.size() > 64) return 0;
    const std::uint64_t messages = count_messages(reader, {});
    count_messages(reader, {{1, 3}, 5, 20});
    read_all(reader);
    if (size % 4 != 0) return 0;  // the rest takes as long as all before
    require(mcap::check(mcap::bytes_of(bytes), limits).faults.size() <= 2 * mcap::most_faults);
    std::string saved;
    const mcap::Repaired repaired = mcap::repair(
        reader, [&](std::string_view some) { saved += some; }, mcap::Compression::none);  // faster
    require(repaired.messages == messages);
    const mcap::Scan scanned = mcap::check(mcap::bytes_of(saved));
    require(scanned.faults.empty());
    require(scanned.contents.statistics.messages == messages);
    require(count_messages(mcap::Reader(mcap::bytes_of(saved)), {}) == messages);
  } catch (const mcap::Damaged& damaged) {
    require(*damaged.what() != '\0');
    require(damaged.offset() <= size);
  }
  return 0;
}
