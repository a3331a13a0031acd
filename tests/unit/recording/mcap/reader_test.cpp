// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>

#include "example.h"
#include "recording/mcap/scan.h"

namespace ziggurat::mcap {
namespace {

constexpr Compression all_compressions[] = {Compression::none, Compression::lz4, Compression::zstd};

TEST(Reader, ReadsWhatWasWritten) {
  for (const Compression compression : all_compressions) {
    const std::string file = example(compression);
    const Reader reader(bytes_of(file));
    EXPECT_TRUE(reader.has_summary());
    EXPECT_TRUE(reader.faults().empty());
    const Contents& contents = reader.contents();
    EXPECT_EQ(contents.header.profile, "test");
    EXPECT_EQ(contents.schemas.at(1).data, "descriptors");
    EXPECT_EQ(contents.channel_of("/b")->metadata, (Map{{"key", "value"}}));
    EXPECT_EQ(contents.channel_of("/c"), nullptr);
    EXPECT_EQ(contents.chunks.size(), 3u);
    EXPECT_EQ(contents.chunks[2].start_time, 20u);
    EXPECT_EQ(contents.chunks[2].end_time, 22u);
    EXPECT_EQ(contents.chunks[0].compression, name_of(compression));
    EXPECT_EQ(contents.statistics.messages, 9u);
    EXPECT_EQ(contents.messages_of(1), 6u);
    EXPECT_EQ(contents.statistics.end_time, 22u);
    EXPECT_EQ(reader.attachment(contents.attachments.at(0)), "<argos/>");
    EXPECT_EQ(reader.metadata(contents.metadata.at(0)).values, (Map{{"seed", "7"}, {"", ""}}));
    const auto messages = read_all(reader);
    ASSERT_EQ(messages.size(), 9u);
    EXPECT_EQ(messages[3], (Read{"/a", 2, 10, "first of 1"}));
    EXPECT_EQ(messages[4], (Read{"/b", 1, 11, "{}"}));
  }
}

TEST(Reader, FindsNothingWrongWithAWholeFile) {
  for (const Compression compression : all_compressions) {
    const std::string file = example(compression);
    const Scan scanned = check(bytes_of(file));
    EXPECT_TRUE(scanned.has_end);
    EXPECT_TRUE(scanned.faults.empty()) << scanned.faults[0].text;
    EXPECT_EQ(scanned.contents.statistics, Reader(bytes_of(file)).contents().statistics);
  }
}

TEST(Reader, ChoosesByChannelAndTime) {
  const std::string file = example(Compression::zstd);
  const Reader reader(bytes_of(file));
  EXPECT_EQ(read_all(reader, {{2}, 11, 20}), (std::vector<Read>{{"/b", 1, 11, "{}"}}));
  EXPECT_EQ(read_all(reader, {{1}, 22}).size(), 1u);
  EXPECT_TRUE(read_all(reader, {{}, 23}).empty());
}

TEST(Reader, SeeksWithoutReadingWhatIsBefore) {
  const std::string file = example(Compression::zstd, 50);
  std::uint64_t read = 0;
  Source source{file.size(), [&](std::uint64_t offset, std::size_t size, std::string& to) {
                  read += size;
                  to += file.substr(offset, size);
                }};
  const Reader reader(source);
  read = 0;
  EXPECT_EQ(read_all(reader, {{}, 490}).size(), 3u);
  EXPECT_EQ(read, reader.contents().chunks.back().length);
}

TEST(Reader, ReadsAFileWithoutMessages) {
  std::string file;
  Writer(into(file), {}, Compression::zstd).close();
  const Reader reader(bytes_of(file));
  EXPECT_TRUE(reader.has_summary());
  EXPECT_TRUE(read_all(reader).empty());
  EXPECT_TRUE(check(bytes_of(file)).faults.empty());
}

TEST(Reader, ReadsFromDisk) {
  const std::string path = ::testing::TempDir() + "mcap_reader_test_" + std::to_string(::getpid());
  std::ofstream(path, std::ios::binary) << example(Compression::zstd);
  EXPECT_EQ(read_all(Reader(open_file(path))).size(), 9u);
  std::remove(path.c_str());
  EXPECT_THROW(open_file(path), std::runtime_error);
  EXPECT_THROW(open_file("/dev/null"), std::runtime_error);
}

TEST(Writer, CountsMessagesOfEachChannel) {
  std::string file;
  Writer writer(into(file), {}, Compression::none);
  const auto channel = writer.add_channel(0, "/late", "");
  writer.write(channel, 5, 5, "late");
  writer.write(channel, 3, 3, "early");
  EXPECT_GT(writer.chunk_size(), 9u);
  writer.close();
  EXPECT_EQ(writer.size(), file.size());
  const Reader reader(bytes_of(file));
  EXPECT_EQ(reader.contents().chunks.at(0).start_time, 3u);
  EXPECT_EQ(read_all(reader),
            (std::vector<Read>{{"/late", 0, 5, "late"}, {"/late", 1, 3, "early"}}));
  EXPECT_TRUE(check(bytes_of(file)).faults.empty());
}

}  // namespace
}  // namespace ziggurat::mcap
