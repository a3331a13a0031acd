// SPDX-License-Identifier: MIT
#include "text/printable.h"

#include <gtest/gtest.h>

namespace ziggurat::text {
namespace {

TEST(Printable, TextIsKept) {
  const std::string text = "a\tb\n\u00e4 \u65e5\u672c \U0001f600";
  EXPECT_EQ(printable(text), text);
  EXPECT_EQ(printable(""), "");
}

TEST(Printable, FurtherLinesAreIndented) {
  EXPECT_EQ(indented("why"), "why");
  EXPECT_EQ(indented("why\nhash 3 0\n"), "why\n    hash 3 0\n    ");
}

TEST(Printable, ControlCharactersAreWrittenAsNumbers) {
  EXPECT_EQ(printable("\x1b]52;c;aGk=\x07"), "\\u001b]52;c;aGk=\\u0007");
  EXPECT_EQ(printable("a\rb\x7f"), "a\\u000db\\u007f");
  EXPECT_EQ(printable(std::string("\0", 1)), "\\u0000");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m"),
            "\\u009b31m")
      << "CSI as one character";
}

TEST(Printable, CharactersThatReorderTextAreWrittenAsNumbers) {
  EXPECT_EQ(printable("a\u202eb\u2066c\u200fd"), "a\\u202eb\\u2066c\\u200fd");
  EXPECT_EQ(printable("a\u2028b"), "a\\u2028b") << "another line";
  const std::string others = "\u2014 \u2026 \u2082";
  EXPECT_EQ(printable(others), others);
}

TEST(Printable, AllCharactersThatAreNotSeenAreWrittenAsNumbers) {
  EXPECT_EQ(printable("a\u061cb"), "a\\u061cb") << "Arabic letter mark: it reorders, too";
  EXPECT_EQ(printable("a\u00adb\u200bc\u200dd\u2060e\u206ff\ufeffg"),
            "a\\u00adb\\u200bc\\u200dd\\u2060e\\u206ff\\ufeffg");
  EXPECT_EQ(printable("a\U000e0001b\U000e007f"), "a\\ue0001b\\ue007f") << "tags";
  const std::string neighbours =
      "\u00ac\u00ae\u061b\u061d\u200a\u2010\u2027\u202f\u205f\u2070\ufefe\U000e0080";
  EXPECT_EQ(printable(neighbours), neighbours);
}

TEST(Printable, OtherBytesBecomeReplacementCharacters) {
  const std::string other = "\xef\xbf\xbd";
  EXPECT_EQ(printable("\x9b"
                      "31m"),
            other + "31m");
  EXPECT_EQ(printable("\xc0\x9b"), other + other) << "too long";
  EXPECT_EQ(printable("\xed\xa0\x80"), other + other + other) << "half of a pair";
  EXPECT_EQ(printable("\xf0\x9f"), other + other) << "cut";
}

TEST(Printable, OfALongerTextThereIsAPart) {
  EXPECT_EQ(printable_part("a\x1b\u202e"), "a\\u001b\\u202e");
  EXPECT_EQ(printable_part("1234567890", 10), "1234567890");
  EXPECT_EQ(printable_part("1234567890a", 10), "1234567\u2026");
  EXPECT_EQ(printable_part("12345\u00e4\u00e4\u00e4\u00e4", 10), "12345\u00e4\u2026")
      << "no character is cut";
  EXPECT_EQ(printable_part("12345\x1b\x1b", 16), "12345\\u001b\u2026") << "no number is cut";
  EXPECT_EQ(printable_part(std::string(1'000'000, '\x1b')).size(), 4096U - 1);
}

TEST(IsUtf8, RefusesWhatPrintableReplaces) {
  for (const char* text : {"", "a\n\x1b", "\u00ac\u2060\U000e0080"})
    EXPECT_TRUE(is_utf8(text)) << text;
  for (const char* text : {"a\x9b", "\xc0\x9b", "\xed\xa0\x80", "b\xf0\x9f"})
    EXPECT_FALSE(is_utf8(text)) << text;
}

}  // namespace
}  // namespace ziggurat::text
