// SPDX-License-Identifier: MIT
#include "text/quoting.h"

#include <gtest/gtest.h>

namespace ziggurat::text {
namespace {

TEST(ShellWord, IsQuotedOnlyIfItMustBe) {
  EXPECT_EQ(shell_word("/a/b-c_1.x"), "/a/b-c_1.x");
  EXPECT_EQ(shell_word("a b"), "'a b'");
  EXPECT_EQ(shell_word("$HOME;`id`"), "'$HOME;`id`'");
  EXPECT_EQ(shell_word("it's"), R"('it'\''s')");
  EXPECT_EQ(shell_word(""), "''");
}

TEST(CsvField, IsQuotedOnlyIfItMustBe) {
  EXPECT_EQ(csv_field("a b"), "a b");
  EXPECT_EQ(csv_field("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_field("say \"x\""), "\"say \"\"x\"\"\"");
  EXPECT_EQ(csv_field("a\nb"), "\"a\nb\"");
  EXPECT_EQ(csv_field(""), "");
}

TEST(CsvField, NoTextIsAFormulaOfASpreadsheet) {
  EXPECT_EQ(csv_field("=1+2"), "'=1+2");
  EXPECT_EQ(csv_field("=HYPERLINK(\"http://x\",\"y\")"),
            "\"'=HYPERLINK(\"\"http://x\"\",\"\"y\"\")\"");
  EXPECT_EQ(csv_field("@SUM(A1)"), "'@SUM(A1)");
  EXPECT_EQ(csv_field("+cmd|' /C calc'!A0"), "'+cmd|' /C calc'!A0");
  EXPECT_EQ(csv_field("-A1"), "'-A1");
  EXPECT_EQ(csv_field("-1+2"), "'-1+2");
  EXPECT_EQ(csv_field("\t=1"), "'\t=1");
  EXPECT_EQ(csv_field("\r=1"), "\"'\r=1\"");
}

TEST(CsvField, NumbersStayNumbers) {
  for (const char* number :
       {"-1.5", "+3", "-1e-300", "-inf", "-0", "-", "1", "a-b", "x=1", "-1e999", "-5%", "+-95%"}) {
    EXPECT_EQ(csv_field(number), number);
  }
  EXPECT_EQ(csv_field("-1,0,0.5"), "\"-1,0,0.5\"");
  EXPECT_EQ(csv_field("-20:40"), "-20:40");
}

TEST(HtmlText, HasNoTagAndNoEndOfAnAttribute) {
  EXPECT_EQ(html_text("a<b> & \"c\" 'd'"), "a&#60;b&#62; &#38; &#34;c&#34; &#39;d&#39;");
  EXPECT_EQ(html_text("\x1b[1m"), "\\u001b[1m");
}

}  // namespace
}  // namespace ziggurat::text
