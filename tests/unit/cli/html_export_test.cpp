#include "cli/html_export.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "temporary_folder.h"
#include "words_of.h"

namespace ziggurat::cli {
namespace {

namespace fs = std::filesystem;

class HtmlExport : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    const std::string path = (folder_ / name).string();
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  static std::string read(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static std::string complaint(const std::string& player, const std::string& recording,
                               const std::string& out) {
    return words_of<std::exception>([&] { export_html(player, recording, out); });
  }

  const std::string magic_{"\x89MCAP0\r\n", 8};

 private:
  TemporaryFolder folder_;
};

TEST_F(HtmlExport, Base64IsThatOfTheStandard) {  // RFC 4648, section 10
  EXPECT_EQ(to_base64(""), "");
  EXPECT_EQ(to_base64("f"), "Zg==");
  EXPECT_EQ(to_base64("fo"), "Zm8=");
  EXPECT_EQ(to_base64("foo"), "Zm9v");
  EXPECT_EQ(to_base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(to_base64(std::string_view("\xff\xfe\xfd\0", 4)), "//79AA==");
}

TEST_F(HtmlExport, TheRecordingAndItsNameStandInThePage) {
  const auto player =
      write("player.html", "<a data-name=\"@NAME@\">@RECORDING@</a> @NAME@ @RECORDING@");
  const auto recording = write("a<\"&b.mcap", magic_ + "foo");
  const std::size_t size = export_html(player, recording, path("out.html"));
  EXPECT_EQ(size, read(path("out.html")).size());
  EXPECT_EQ(read(path("out.html")), "<a data-name=\"a&#60;&#34;&#38;b.mcap\">" +
                                        to_base64(magic_ + "foo") + "</a> @NAME@ @RECORDING@");
  EXPECT_FALSE(fs::exists(path("out.html.part")));
}

TEST_F(HtmlExport, LinksAndDevicesStayWhatTheyAre) {
  const auto player = write("player.html", "@NAME@ @RECORDING@"),
             recording = write("r.mcap", magic_);
  const auto target = write("target", "old");
  fs::create_symlink("target", path("link"));
  fs::create_symlink("/dev/null", path("nothing"));
  export_html(player, recording, path("link"));
  export_html(player, recording, path("nothing"));
  EXPECT_TRUE(fs::is_symlink(path("link")) && fs::is_symlink(path("nothing")));
  EXPECT_EQ(read(target), "r.mcap " + to_base64(magic_));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(HtmlExport, ADashIsStdout) {
  const auto player = write("player.html", "@NAME@ @RECORDING@"),
             recording = write("r.mcap", magic_);
  testing::internal::CaptureStdout();
  const std::size_t size = export_html(player, recording, "-");
  const std::string page = testing::internal::GetCapturedStdout();
  EXPECT_EQ(page, "r.mcap " + to_base64(magic_));
  EXPECT_EQ(size, page.size());
}

TEST_F(HtmlExport, ALargeRecordingIsOneText) {
  const auto player = write("player.html", "@NAME@|@RECORDING@|");
  std::string bytes = magic_;
  for (int i = 0; i < 7'000'001; ++i) bytes += static_cast<char>(i * 31);
  export_html(player, write("r.mcap", bytes), path("out.html"));
  EXPECT_EQ(read(path("out.html")), "r.mcap|" + to_base64(bytes) + "|");
}

TEST_F(HtmlExport, WhatIsMissingIsToldInASentence) {
  const auto player = write("player.html", "@NAME@ @RECORDING@");
  const auto recording = write("r.mcap", magic_);
  EXPECT_NE(
      complaint(path("none.html"), recording, path("out.html")).find("the page was not built"),
      std::string::npos);
  EXPECT_NE(complaint(write("old.html", "nothing"), recording, path("out.html"))
                .find("build the page again"),
            std::string::npos);
  EXPECT_NE(complaint(player, write("text.mcap", "hello, world"), path("out.html"))
                .find("is no recording"),
            std::string::npos);
  EXPECT_NE(complaint(player, path("none.mcap"), path("out.html")).find("can't be read"),
            std::string::npos);
  EXPECT_NE(complaint(player, recording, path("none/out.html")).find("can't be written"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(path("out.html")));
}

}  // namespace
}  // namespace ziggurat::cli
