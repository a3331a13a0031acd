// SPDX-License-Identifier: MIT
#include "outputs/output_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "file_text.h"
#include "words_of.h"

namespace ziggurat::outputs {
namespace {

TEST(OutputFile, ContainsEverythingAfterClose) {
  const auto path = scratch("file");
  std::string expected;
  OutputFile file(path);
  for (int i = 0; i < 100000; ++i) {
    const std::string line = fmt::format("line {}\n", i);
    expected += line;
    file.buffer().append(line);
    file.written();
  }
  file.close();
  EXPECT_EQ(text_of(path), expected);
}

TEST(OutputFile, ReplacesAnExistingFile) {
  const auto path = scratch("file");
  for (const std::string text : {"a longer text", "short"}) {
    OutputFile file(path);
    file.buffer().append(text);
    file.close();
    EXPECT_EQ(text_of(path), text);
  }
}

TEST(OutputFile, ADashIsStdout) {
  testing::internal::CaptureStdout();
  OutputFile file("-");
  file.buffer().append(std::string_view("a line\n"));
  file.close();
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "a line\n");
}

TEST(OutputFile, HasOneWriter) {
  const auto path = scratch("file");
  OutputFile file(path);
  file.buffer().append(std::string_view("a line\n"));
  file.flush();
  const std::string words = words_of<WriteError>([&] { OutputFile other(path); });
  EXPECT_EQ(words, path + ": cannot be written: another program writes to it; name another file");
  EXPECT_EQ(text_of(path), "a line\n") << "was not emptied";
  file.close();
  EXPECT_NO_THROW(OutputFile{path});
}

TEST(OutputFile, ReportsThatItWasRemoved) {
  const auto path = scratch("file");
  OutputFile file(path);
  ::unlink(path.c_str());
  EXPECT_THROW(file.close(), WriteError);
  EXPECT_NO_THROW(file.close());
}

TEST(OutputFile, ReportsThatItWasShortened) {
  const auto path = scratch("file");
  OutputFile file(path);
  file.buffer().append(std::string_view("a line\n"));
  file.flush();
  ASSERT_EQ(::truncate(path.c_str(), 2), 0);
  file.buffer().append(std::string_view("another line\n"));
  const std::string words = words_of<WriteError>([&] { file.close(); });
  EXPECT_EQ(
      words,
      path + ": was shortened by another program while it was written: 5 bytes of 20 are lost");
  EXPECT_EQ(text_of(path), "a another line\n") << "without a hole";
}

TEST(OutputFile, ReportsWhyItCannotBeCreated) {
  EXPECT_EQ(words_of<WriteError>([&] { OutputFile file("/no/such/folder/file.csv"); }),
            "/no/such/folder/file.csv: cannot be written: No such file or directory");
}

TEST(OutputFile, ReportsAFullDisk) {
  OutputFile file("/dev/full");
  file.buffer().append(std::string_view("something"));
  file.written();
  EXPECT_THROW(file.close(), WriteError);
  EXPECT_NO_THROW(file.close()) << "it is closed now";
}

TEST(OutputFile, ReportsAFullDiskAsSoonAsTheBufferIsFull) {
  OutputFile file("/dev/full");
  file.buffer().append(std::string(1 << 20, 'x'));
  EXPECT_THROW(file.written(), WriteError);
}

}  // namespace
}  // namespace ziggurat::outputs
