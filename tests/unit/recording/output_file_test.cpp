#include "recording/output_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "file_text.h"
#include "recording/images.h"
#include "recording/output_name.h"
#include "text/numbers.h"

namespace ziggurat::recording {
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
  try {
    OutputFile other(path);
    ADD_FAILURE() << "both write";
  } catch (const WriteError& error) {
    EXPECT_EQ(std::string(error.what()), path + ": cannot be written: another program writes to it; name another file");
  }
  EXPECT_EQ(text_of(path), "a line\n") << "was not emptied";
  file.close();
  EXPECT_NO_THROW(OutputFile{path});
}

TEST(OutputFile, ReportsThatItWasRemoved) {
  const auto path = scratch("file");
  OutputFile file(path), anonymous("/proc/self/fd/" + std::to_string(::open(testing::TempDir().c_str(), O_TMPFILE | O_RDWR, 0600)));
  ::unlink(path.c_str());
  EXPECT_THROW(file.close(), WriteError);
  EXPECT_NO_THROW(file.close());
  EXPECT_NO_THROW(anonymous.close()) << "had no name before";
}

TEST(OutputFile, ReportsThatItWasShortened) {
  const auto path = scratch("file");
  OutputFile file(path);
  file.buffer().append(std::string_view("a line\n"));
  file.flush();
  ASSERT_EQ(::truncate(path.c_str(), 2), 0);
  file.buffer().append(std::string_view("another line\n"));
  try {
    file.close();
    ADD_FAILURE() << "was not told";
  } catch (const WriteError& error) {
    EXPECT_EQ(std::string(error.what()), path + ": was shortened by another program while it was written: 5 bytes of 20 are lost");
  }
  EXPECT_EQ(text_of(path), "a another line\n") << "without a hole";
}

/// A folder that all can write, as /tmp.
class SharedFolder : public testing::Test {
 protected:
  static constexpr uid_t another = 12'345;

  SharedFolder() {
    ::mkdir(folder_.c_str(), 0700);
    ::chmod(folder_.c_str(), 01777);
    std::ofstream(kept_) << "kept";
  }
  ~SharedFolder() override { std::filesystem::remove_all(folder_); }

  static std::string complaint(const std::string& path) {
    try {
      OutputFile file(path);
      return "none";
    } catch (const WriteError& error) {
      return error.what();
    }
  }

  const std::string folder_ = scratch("folder"), place_ = folder_ + "/out.csv", kept_ = folder_ + "/kept";
};

TEST_F(SharedFolder, WhatAnotherUserHasPlantedIsNotWrittenTo) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root makes files of others";
  ASSERT_EQ(::chown(folder_.c_str(), 1, 1), 0) << "not of root, whose files would be trusted";
  ASSERT_EQ(::symlink(kept_.c_str(), place_.c_str()), 0);
  EXPECT_EQ(complaint(place_), "none") << "a link of ours";
  std::ofstream(kept_) << "kept";
  ASSERT_EQ(::lchown(place_.c_str(), another, another), 0);
  EXPECT_EQ(complaint(place_), place_ + ": cannot be written: it is a link of another user in a folder that all can write");
  EXPECT_EQ(text_of(kept_), "kept");
  EXPECT_THROW(check_output({"--csv", place_, {".csv"}}), text::UsageError);
  ::unlink(place_.c_str());
  std::ofstream(place_) << "theirs";
  EXPECT_EQ(complaint(place_), "none") << "a file of ours";
  ASSERT_EQ(::chown(place_.c_str(), another, another), 0);
  EXPECT_EQ(complaint(place_), place_ + ": cannot be written: it is a file of another user in a folder that all can write");
  ASSERT_EQ(::chmod(folder_.c_str(), 0775), 0);
  EXPECT_EQ(complaint(place_), "none") << "in a folder of few";
}

TEST_F(SharedFolder, NothingIsRedirectedInAFolderThatAnotherUserHasPlanted) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root makes files of others";
  const std::string theirs = folder_ + "/theirs", out = theirs + "/out.csv", inner = theirs + "/inner";
  ASSERT_EQ(::mkdir(theirs.c_str(), 0755), 0);
  ASSERT_EQ(::mkdir(inner.c_str(), 0755), 0);
  for (const auto& each : {theirs, inner}) ASSERT_EQ(::chown(each.c_str(), another, another), 0);
  const std::string of_theirs = ": cannot be written: it is a link of another user in a folder that stands where all can write";
  for (const std::string& link : {out, inner + "/out.csv"}) {
    ASSERT_EQ(::symlink(kept_.c_str(), link.c_str()), 0);
    ASSERT_EQ(::lchown(link.c_str(), another, another), 0);
    EXPECT_EQ(complaint(link), link + of_theirs);
    EXPECT_THROW(check_output({"--csv", link, {".csv"}}), text::UsageError);
    EXPECT_EQ(text_of(kept_), "kept");
    ::unlink(link.c_str());
  }
  ASSERT_EQ(::mkfifo(out.c_str(), 0666), 0);
  ASSERT_EQ(::chown(out.c_str(), another, another), 0);
  EXPECT_NE(complaint(out).find("it is a pipe or device of another user"), std::string::npos) << "which could be waited for";
  ::unlink(out.c_str());
  EXPECT_EQ(complaint(out), "none") << "a file of a group's folder";
  ASSERT_EQ(::chown(out.c_str(), another, another), 0);
  EXPECT_EQ(complaint(out), "none") << "likewise";
}

TEST_F(SharedFolder, NoLinkOfAnotherUserLeadsToTheFolderOfAnOutput) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root makes files of others";
  const std::string mine = folder_ + "/mine", link = folder_ + "/link", file = "/../mine/./out.csv";
  ASSERT_EQ(::mkdir(mine.c_str(), 0755), 0);
  ASSERT_EQ(::symlink(mine.c_str(), link.c_str()), 0);
  EXPECT_EQ(complaint(link + file), "none") << "a link of ours";
  EXPECT_TRUE(std::filesystem::exists(mine + "/out.csv"));
  ASSERT_EQ(::lchown(link.c_str(), another, another), 0);
  EXPECT_EQ(complaint(link + file), link + file + ": cannot be written: it is below a link of another user in a folder that all can write");
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(mine);
  EXPECT_THROW(Images("../link/new", {}), WriteError);
  EXPECT_FALSE(std::filesystem::exists(mine + "/new"));
  EXPECT_EQ(complaint("../link/out.csv"), "../link/out.csv: cannot be written: it is below a link of another user in a folder that all can write");
  EXPECT_EQ(complaint("out.csv"), "none");
  std::filesystem::current_path(before);
}

TEST_F(SharedFolder, LinksThatLeadInACircleAndFoldersAreTold) {
  ASSERT_EQ(::symlink(place_.c_str(), place_.c_str()), 0);
  EXPECT_EQ(complaint(place_), place_ + ": cannot be written: Too many levels of symbolic links");
  EXPECT_EQ(complaint(folder_), folder_ + ": cannot be written: Is a directory");
  EXPECT_EQ(complaint(folder_ + "/"), folder_ + "/: cannot be written: Is a directory");
  EXPECT_EQ(complaint(kept_ + "/file"), kept_ + "/file: cannot be written: Not a directory");
}

TEST_F(SharedFolder, WhoMayOnlyReadAFileKeepsNobodyFromWritingToIt) {
  OutputFile{place_}.close();
  const int theirs = ::open(place_.c_str(), O_RDONLY);
  ASSERT_EQ(::flock(theirs, LOCK_EX | LOCK_NB), 0);
  struct flock lock {};
  lock.l_type = F_RDLCK;
  ASSERT_EQ(::fcntl(theirs, F_OFD_SETLK, &lock), 0);
  EXPECT_EQ(complaint(place_), "none");
  ::close(theirs);
  const OutputFile writer(place_);
  EXPECT_NE(complaint(place_).find("another program writes to it"), std::string::npos);
}

TEST_F(SharedFolder, LinksOfOursMayLeadToFilesThatAreNotThere) {
  ASSERT_EQ(::symlink((folder_ + "/new").c_str(), place_.c_str()), 0);
  EXPECT_EQ(complaint(place_), "none");
  EXPECT_TRUE(std::filesystem::exists(folder_ + "/new"));
}

TEST(OutputFile, ReportsWhyItCannotBeCreated) {
  try {
    OutputFile file("/no/such/folder/file.csv");
    FAIL() << "created";
  } catch (const WriteError& error) {
    EXPECT_STREQ(error.what(),
                 "/no/such/folder/file.csv: cannot be written: No such file or directory");
  }
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
}  // namespace ziggurat::recording
