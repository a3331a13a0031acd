// SPDX-License-Identifier: MIT
// Files that were made to harm their reader.

#include <gtest/gtest.h>

#include <array>

#include "example.h"
#include "recording/mcap/bytes.h"
#include "recording/mcap/encode.h"
#include "recording/mcap/scan.h"

namespace ziggurat::mcap {
namespace {

/// The beginning of a file, without an end.
std::string beginning() {
  std::string file(magic);
  append(Header{"test", ""}, file);
  return file;
}

/// Opens a file and reads all of it that can be read.
std::size_t read_what_can_be(const std::string& file) {
  const Reader reader(bytes_of(file));
  Messages messages(reader, {});
  std::size_t read = 0;
  for (int tries = 0; tries < 100; ++tries) {
    try {
      while (messages.next()) ++read;
      return read;
    } catch (const Damaged&) {
    }
  }
  return read;
}

TEST(Hostile, AChunkThatSaysItIsHugeTakesNoMemory) {
  for (const char* compression : {"", "zstd", "lz4"}) {
    std::string file = beginning();
    ChunkIndex index;
    index.compression = compression;
    index.uncompressed_size = std::uint64_t{1} << 60;
    append_chunk(index, 0, "x", file);
    const Scan scanned = scan(bytes_of(file), {});
    EXPECT_TRUE(scanned.contents.chunks.empty());
    EXPECT_EQ(scanned.damaged_chunks, 1u);
    EXPECT_EQ(read_what_can_be(file), 0u);
  }
}

TEST(Hostile, AChunkThatGrowsIsBounded) {
  Compressor compressor(Compression::zstd);
  const std::string_view bomb = compressor.compress(std::string(std::size_t{8} << 20, 'x'));
  ChunkIndex index;
  index.compression = "zstd";
  index.uncompressed_size = 1000;
  std::string file = beginning();
  append_chunk(index, 0, bomb, file);
  EXPECT_EQ(scan(bytes_of(file), {}).damaged_chunks, 1u);
  index.uncompressed_size = std::uint64_t{8} << 20;
  file = beginning();
  append_chunk(index, 0, bomb, file);
  Limits small;
  small.chunk = std::size_t{1} << 20;
  EXPECT_EQ(scan(bytes_of(file), small).damaged_chunks, 1u);
}

TEST(Hostile, ARecordLongerThanTheFileEndsTheScan) {
  std::string file = beginning();
  file.push_back('\x09');
  put(~std::uint64_t{0}, file);
  file += "attachment";
  const Scan scanned = scan(bytes_of(file), {});
  EXPECT_FALSE(scanned.has_end);
  ASSERT_EQ(scanned.faults.size(), 1u);
  EXPECT_EQ(scanned.faults[0].offset, beginning().size());
}

/// A file whose summary is this, with right CRCs.
std::string with_summary(const std::string& summary) {
  std::string file = beginning();
  append_data_end(crc32(file), file);
  std::string end = summary;
  append_without_crc({file.size(), 0, 0}, end);
  put(crc32(end), end);
  return file + end + std::string(magic);
}

TEST(Hostile, IndexesMayReferToAnything) {
  for (const std::uint64_t offset : {std::uint64_t{0}, std::uint64_t{8}, ~std::uint64_t{0}}) {
    for (const std::uint64_t length : {std::uint64_t{0}, std::uint64_t{9}, ~std::uint64_t{0}}) {
      ChunkIndex chunk;
      chunk.offset = offset;
      chunk.length = length;
      chunk.end_time = ~std::uint64_t{0};
      std::array<std::string, 3> summaries;
      append(chunk, summaries[0]);
      append(AttachmentIndex{offset, length, 0, 0, 0, "a", ""}, summaries[1]);
      append(MetadataIndex{offset, length, "m"}, summaries[2]);
      for (const std::string& summary : summaries) {
        const std::string file = with_summary(summary);
        const Reader reader(bytes_of(file));
        EXPECT_TRUE(reader.has_summary());
        const Contents& contents = reader.contents();
        for (const auto& each : contents.chunks) EXPECT_THROW(reader.chunk(each), Damaged);
        for (const auto& each : contents.attachments)
          EXPECT_THROW(reader.attachment(each), Damaged);
        for (const auto& each : contents.metadata) EXPECT_THROW(reader.metadata(each), Damaged);
        EXPECT_EQ(read_what_can_be(file), 0u);
        EXPECT_FALSE(check(bytes_of(file)).faults.empty());
      }
    }
  }
}

/// Else an export or a repair of a small file would have terabytes.
TEST(Hostile, ASummaryThatListsAPlaceTwiceIsNotUsed) {
  ChunkIndex chunk;
  chunk.offset = 8;
  chunk.length = 100;
  const AttachmentIndex attachment{8, 100, 0, 0, 0, "a", ""},
      overlapping{107, 100, 0, 0, 0, "b", ""}, next{108, 100, 0, 0, 0, "c", ""};
  const MetadataIndex beyond{~std::uint64_t{0} - 50, 100, "m"};
  std::array<std::string, 5> summaries;
  append(chunk, summaries[0]);
  append(chunk, summaries[0]);
  append(attachment, summaries[1]);
  append(attachment, summaries[1]);
  append(chunk, summaries[2]);
  append(overlapping, summaries[2]);
  append(beyond, summaries[3]);
  append(beyond, summaries[3]);
  append(next, summaries[4]);
  append(chunk, summaries[4]);
  append(beyond, summaries[4]);
  for (std::size_t i = 0; i < summaries.size(); ++i) {
    EXPECT_EQ(Reader(bytes_of(with_summary(summaries[i]))).has_summary(), i == 4) << i;
  }
}

TEST(Hostile, DefinitionsAreBounded) {
  std::string file = beginning();
  for (std::uint16_t id = 1; id < 100; ++id) {
    append(Schema{id, "type", "protobuf", std::string(1000, 'x')}, file);
  }
  Limits small;
  small.index = 10'000;
  const Scan scanned = scan(bytes_of(file), small);
  EXPECT_LE(scanned.contents.schemas.size(), 10u);
  EXPECT_FALSE(scanned.faults.empty());
}

TEST(Hostile, ASummaryThatIsTooLargeIsNotRead) {
  std::string summary;
  for (int i = 0; i < 100; ++i) append(MetadataIndex{8, 9, std::string(1000, 'x')}, summary);
  const std::string file = with_summary(summary);
  Limits small;
  small.index = 10'000;
  EXPECT_FALSE(Reader(bytes_of(file), small).has_summary());
}

TEST(Hostile, FaultsAreBounded) {
  std::string file = beginning();
  for (int i = 0; i < 1000; ++i) {
    file.push_back('\x05');
    put(std::uint64_t{0}, file);
  }
  EXPECT_EQ(scan(bytes_of(file), {}).faults.size(), most_faults);
}

}  // namespace
}  // namespace ziggurat::mcap
