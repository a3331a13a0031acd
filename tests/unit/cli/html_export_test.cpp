// SPDX-License-Identifier: MIT
#include "cli/html_export.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "recording/mcap/messages.h"
#include "recording/mcap/writer.h"
#include "temporary_folder.h"
#include "words_of.h"

namespace ziggurat::cli {
namespace {

namespace fs = std::filesystem;

/// The bytes of letters that to_base64() made, also of several texts in a row that are whole.
std::string from_base64(std::string_view letters) {
  constexpr std::string_view all =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char letter : letters) {
    if (letter == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(all.find(letter));
    if ((count += 6) < 8) continue;
    bytes += static_cast<char>(bits >> (count -= 8) & 255);
  }
  return bytes;
}

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
  /// A recording with one message of some bytes in each of these topics.
  static std::string recorded(const std::vector<std::string>& topics, std::size_t size = 10) {
    std::string file;
    mcap::Writer writer([&](std::string_view more) { file += more; }, {"ziggurat", "test"},
                        mcap::Compression::none);
    std::string data;
    for (std::size_t i = 0; i < size; ++i) data += static_cast<char>(i * i % 251);
    for (const auto& topic : topics)
      writer.write(writer.add_channel(0, topic, "protobuf"), 5, 5, data);
    writer.attach("scene.argos", "application/xml", "<xml>", 0, 0);
    writer.close();
    return file;
  }
  static mcap::Reader reader(const std::string& bytes) {
    return mcap::Reader(mcap::bytes_of(bytes));
  }
  static std::string complaint(const std::string& player, const std::string& out) {
    const std::string file = recorded({"/poses"});
    return words_of<std::exception>([&] { export_html(player, "r.mcap", reader(file), out); });
  }

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

const std::string player_text = "begin <!--@RECORDING@--> rest <!--@RECORDING@-->";

/// The recording inside of a page.
std::string embedded(const std::string& page) {
  std::string letters;
  for (std::size_t number = 0;; ++number) {
    const std::string tag =
        "<script type=\"application/octet-stream\" id=\"part" + std::to_string(number) + "\">";
    const auto begin = page.find(tag);
    if (begin == std::string::npos) return from_base64(letters);
    const auto at = begin + tag.size();
    letters += page.substr(at, page.find("</script>", at) - at);
  }
}

TEST_F(HtmlExport, ThePageHasWhatItShowsOfTheRecording) {
  const auto player = write("player.html", player_text);
  const std::string file = recorded({"/poses", "/state", "/tf", "/scene", "/robots/r/command"});
  const std::size_t size = export_html(player, "a<\"&b.mcap", reader(file), path("out.html"));
  const std::string page = read(path("out.html")), inside = embedded(page);
  EXPECT_EQ(size, page.size());
  const std::string begin =
      "begin <template id=\"recording\" data-name=\"a&#60;&#34;&#38;b.mcap\" "
      "data-size=\"" +
      std::to_string(inside.size()) + "\" data-part=\"786432\"></template>\n";
  EXPECT_EQ(page.substr(0, begin.size()), begin);
  EXPECT_TRUE(page.ends_with("</script>\n rest <!--@RECORDING@-->"));
  const mcap::Reader found = reader(inside);
  EXPECT_TRUE(found.has_summary());
  EXPECT_EQ(found.contents().channels.size(), 2u);
  EXPECT_NE(found.contents().channel_of("/poses"), nullptr);
  EXPECT_EQ(found.contents().channel_of("/state"), nullptr);
  EXPECT_EQ(found.contents().statistics.messages, 2u);
  EXPECT_TRUE(found.contents().attachments.empty());
  EXPECT_TRUE(found.contents().chunks[0].message_index_offsets.empty());
  EXPECT_FALSE(fs::exists(path("out.html.part")));
}

TEST_F(HtmlExport, ALargeRecordingHasSeveralParts) {
  const auto player = write("player.html", player_text);
  const std::string file = recorded({"/poses", "/contacts", "/rays"}, 2'000'000);
  export_html(player, "r.mcap", reader(file), path("out.html"));
  const std::string inside = embedded(read(path("out.html")));
  const mcap::Reader found = reader(inside);
  mcap::Messages messages(found, {});
  for (std::size_t i = 0; i < 3; ++i) {
    const auto message = messages.next();
    ASSERT_TRUE(message);
    EXPECT_EQ(message->data.size(), 2'000'000u);
  }
  EXPECT_FALSE(messages.next());
}

TEST_F(HtmlExport, LinksAndDevicesStayWhatTheyAre) {
  const auto player = write("player.html", player_text), target = write("target", "old");
  const std::string file = recorded({"/poses"});
  fs::create_symlink("target", path("link"));
  fs::create_symlink("/dev/null", path("nothing"));
  export_html(player, "r.mcap", reader(file), path("link"));
  export_html(player, "r.mcap", reader(file), path("nothing"));
  EXPECT_TRUE(fs::is_symlink(path("link")) && fs::is_symlink(path("nothing")));
  EXPECT_TRUE(read(target).starts_with("begin <template"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(HtmlExport, ADashIsStdout) {
  const auto player = write("player.html", player_text);
  const std::string file = recorded({"/poses"});
  testing::internal::CaptureStdout();
  const std::size_t size = export_html(player, "r.mcap", reader(file), "-");
  const std::string page = testing::internal::GetCapturedStdout();
  EXPECT_TRUE(page.starts_with("begin <template"));
  EXPECT_EQ(size, page.size());
}

TEST_F(HtmlExport, WhatIsMissingIsToldInASentence) {
  const auto player = write("player.html", player_text);
  EXPECT_NE(complaint(path("none.html"), path("out.html")).find("the page was not built"),
            std::string::npos);
  EXPECT_NE(complaint(write("old.html", "nothing"), path("out.html")).find("build the page again"),
            std::string::npos);
  EXPECT_NE(complaint(player, path("none/out.html")).find("can't be written"), std::string::npos);
  EXPECT_FALSE(fs::exists(path("out.html")));
}

}  // namespace
}  // namespace ziggurat::cli
