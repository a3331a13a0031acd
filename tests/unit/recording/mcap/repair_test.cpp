// SPDX-License-Identifier: MIT
#include "recording/mcap/repair.h"

#include <gtest/gtest.h>

#include "example.h"
#include "recording/mcap/scan.h"

namespace ziggurat::mcap {
namespace {

TEST(Repair, CompletesAFileThatIsCutOff) {
  const std::string file = example(Compression::lz4);
  const Reader whole(bytes_of(file));
  const ChunkIndex& last = whole.contents().chunks.back();
  const std::string part = file.substr(0, last.offset + last.length / 2);
  std::string saved;
  const Repaired repaired = repair(Reader(bytes_of(part)), into(saved));
  EXPECT_EQ(repaired.messages, 6u);
  EXPECT_EQ(repaired.chunks, 2u);
  EXPECT_EQ(repaired.attachments, 1u);
  EXPECT_TRUE(repaired.lost.empty());
  EXPECT_TRUE(check(bytes_of(saved)).faults.empty());
  const Reader reader(bytes_of(saved));
  auto expected = read_all(whole);
  expected.resize(6);
  EXPECT_EQ(read_all(reader), expected);
  EXPECT_EQ(reader.contents().schemas, whole.contents().schemas);
  EXPECT_EQ(reader.contents().channels, whole.contents().channels);
  EXPECT_EQ(reader.attachment(reader.contents().attachments.at(0)), "<argos/>");
}

TEST(Repair, LeavesOutWhatIsDamaged) {
  std::string file = example(Compression::zstd);
  const ChunkIndex first = Reader(bytes_of(file)).contents().chunks.at(0);
  file[first.offset + first.length - 2] ^= 8;
  file[file.find("<argos/>")] ^= 1;
  std::string saved;
  const Repaired repaired = repair(Reader(bytes_of(file)), into(saved));
  EXPECT_EQ(repaired.messages, 6u);
  EXPECT_EQ(repaired.lost.size(), 2u);
  EXPECT_TRUE(check(bytes_of(saved)).faults.empty());
  EXPECT_EQ(read_all(Reader(bytes_of(saved))).front().time, 10u);
}

}  // namespace
}  // namespace ziggurat::mcap
