#include "text/trim.h"

#include <gtest/gtest.h>

namespace ziggurat::text {
namespace {

TEST(Trimmed, LosesWhiteSpaceAtItsEndsOnly) {
  EXPECT_EQ(trimmed(" \t\r\na b \n"), "a b");
  EXPECT_EQ(trimmed("ab"), "ab");
  EXPECT_EQ(trimmed(" \n "), "");
  EXPECT_EQ(trimmed(""), "");
}

}  // namespace
}  // namespace ziggurat::text
