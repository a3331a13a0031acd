// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>

#include "example.h"
#include "recording/mcap/encode.h"
#include "recording/mcap/scan.h"

namespace ziggurat::mcap {
namespace {

/// Whether a check finds something wrong.
bool is_found(const std::string& file) {
  try {
    return !check(bytes_of(file)).faults.empty();
  } catch (const Damaged&) {
    return true;
  }
}

TEST(Damage, AFlippedBitAnywhereIsFound) {
  for (const Compression compression : {Compression::none, Compression::lz4, Compression::zstd}) {
    std::string file = example(compression);
    ASSERT_FALSE(is_found(file));
    for (std::size_t i = 0; i < file.size(); ++i) {
      const int bit = static_cast<int>(i % 8);
      file[i] = static_cast<char>(file[i] ^ (1 << bit));
      EXPECT_TRUE(is_found(file)) << "byte " << i << ", bit " << bit;
      file[i] = static_cast<char>(file[i] ^ (1 << bit));
    }
  }
}

/// Many writers put schemas and channels into chunks; then they are no larger than they are.
TEST(Damage, DefinitionsInLargeChunksTakeTheirOwnSizeOnly) {
  std::string records;
  for (std::uint16_t id = 1; id <= 8; ++id) {
    append(Schema{id, "Type", "protobuf", "x"}, records);
    append(Channel{id, id, "/topic", "protobuf", {}}, records);
    append(Message{id, 0, 5, 5, std::string(1000, 'x')}, records);
  }
  std::string file(magic);
  append(Header{"other", "test"}, file);
  ChunkIndex index;
  index.start_time = index.end_time = 5;
  index.uncompressed_size = records.size();
  append_chunk(index, 0, records, file);
  Limits limits;
  limits.index = 4 * records.size();
  const Scan scanned = scan(bytes_of(file), limits);
  EXPECT_EQ(scanned.contents.channels.size(), 8U);
  EXPECT_EQ(scanned.contents.statistics.messages, 8U);
  EXPECT_EQ(scanned.contents.chunks.size(), 1U);
}

/// Number of messages in chunks that end there or before.
std::size_t messages_before(const Reader& whole, std::size_t size) {
  std::size_t count = 0;
  for (const ChunkIndex& chunk : whole.contents().chunks) {
    if (chunk.offset + chunk.length <= size) count += 3;
  }
  return count;
}

TEST(Damage, AFileThatIsCutOffHasAllWholeChunks) {
  const std::string file = example(Compression::zstd);
  const Reader whole(bytes_of(file));
  const auto all = read_all(whole);
  for (std::size_t size = magic.size(); size < file.size(); ++size) {
    const std::string part = file.substr(0, size);
    const Reader reader(bytes_of(part));
    EXPECT_FALSE(reader.has_summary());
    EXPECT_FALSE(reader.faults().empty());
    const auto messages = read_all(reader);
    ASSERT_EQ(messages.size(), messages_before(whole, size)) << size;
    EXPECT_TRUE(std::equal(messages.begin(), messages.end(), all.begin()));
    EXPECT_TRUE(is_found(part));
  }
}

/// Without compression only the chunk's CRC tells it.
class DamagedChunk : public testing::TestWithParam<Compression> {};
INSTANTIATE_TEST_SUITE_P(Of, DamagedChunk,
                         testing::Values(Compression::none, Compression::lz4, Compression::zstd));

TEST_P(DamagedChunk, TakesNoOtherAlong) {
  std::string file = example(GetParam());
  const Reader whole(bytes_of(file));
  const ChunkIndex& second = whole.contents().chunks[1];
  file[second.offset + second.length - 4] ^= 1;
  const Reader reader(bytes_of(file));
  Messages messages(reader, {});
  std::size_t read = 0, damaged = 0;
  for (bool is_over = false; !is_over;) {
    try {
      const auto message = messages.next();
      is_over = !message;
      read += message ? 1 : 0;
    } catch (const Damaged& error) {
      ++damaged;
      EXPECT_EQ(error.offset(), second.offset);
    }
  }
  EXPECT_EQ(read, 6u);
  EXPECT_EQ(damaged, 1u);
  const Scan scanned = check(bytes_of(file));
  EXPECT_EQ(scanned.damaged_chunks, 1u);
  const auto tells = [&](const Fault& fault) { return fault.offset == second.offset; };
  EXPECT_TRUE(std::ranges::any_of(scanned.faults, tells));
}

TEST(Damage, ADamagedAttachmentIsNotRead) {
  std::string file = example(Compression::none);
  file[file.find("<argos/>")] ^= 1;
  const Reader reader(bytes_of(file));
  EXPECT_THROW(reader.attachment(reader.contents().attachments.at(0)), Damaged);
}

TEST(Damage, WhatIsNoMcapFileIsRefused) {
  for (const std::string text : {"", "\x89", "MCAP0\r\n\x89", "<argos-configuration/>"}) {
    EXPECT_THROW(Reader{bytes_of(text)}, Damaged);
    EXPECT_THROW(check(bytes_of(text)), Damaged);
  }
}

}  // namespace
}  // namespace ziggurat::mcap
