// SPDX-License-Identifier: MIT
#include "text/shortened.h"

#include <gtest/gtest.h>

namespace ziggurat::text {
namespace {

TEST(Shortened, KeepsWhatIsShortAndTheBeginningOfTheRest) {
  EXPECT_EQ(shortened("a name"), "a name");
  EXPECT_EQ(shortened(std::string(100, 'x')), std::string(100, 'x'));
  EXPECT_EQ(shortened(std::string(3'000'000, 'x')), std::string(100, 'x') + "…");
  EXPECT_EQ(shortened("aéb", 2), "a…") << "whole characters";
  EXPECT_EQ(shortened("\x80\x80\x80", 2), "…");
}

TEST(ShortenedMessage, LosesTheMiddleOfLongWordsAndOfAllThatIsLonger) {
  const std::string plain =
      "t:2:6: <b> of\tline 2\n  has a word of 160 bytes " + std::string(160, 'w') + " ";
  EXPECT_EQ(shortened_message(plain), plain);
  EXPECT_EQ(shortened_message(""), "");
  EXPECT_EQ(
      shortened_message("at /" + std::string(3'000'000, 'p') + "/scene.argos:12:3 and more"),
      "at /" + std::string(99, 'p') + "…" + std::string(23, 'p') + "/scene.argos:12:3 and more");
  std::string accents;
  for (int i = 0; i < 200; ++i) accents += "é";
  const std::string shorter = shortened_message("x" + accents);
  EXPECT_EQ(shorter.size(), 99 + 3 + 40u) << "whole characters";
  std::string words = "begin ";
  for (int i = 0; i < 1'000'000; ++i) words += "a ";
  const std::string ends = shortened_message(words + "end");
  EXPECT_EQ(ends.size(), 3903u);
  EXPECT_TRUE(ends.starts_with("begin a ") && ends.ends_with(" a end")) << ends;
}

TEST(Trimmed, LosesWhiteSpaceAtItsEndsOnly) {
  EXPECT_EQ(trimmed(" \t\r\na b \n"), "a b");
  EXPECT_EQ(trimmed("ab"), "ab");
  EXPECT_EQ(trimmed(" \n "), "");
  EXPECT_EQ(trimmed(""), "");
}

}  // namespace

}  // namespace ziggurat::text
