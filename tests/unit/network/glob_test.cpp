// SPDX-License-Identifier: MIT
#include "network/glob.h"

#include <gtest/gtest.h>

#include <string>

namespace ziggurat::network {
namespace {

TEST(Glob, Literals) {
  EXPECT_TRUE(matches("robot0", "robot0"));
  EXPECT_FALSE(matches("robot0", "robot01"));
  EXPECT_FALSE(matches("robot01", "robot0"));
  EXPECT_TRUE(matches("", ""));
  EXPECT_FALSE(matches("", "x"));
}

TEST(Glob, Wildcards) {
  EXPECT_TRUE(matches("*", ""));
  EXPECT_TRUE(matches("*", "anything"));
  EXPECT_TRUE(matches("ro*t?", "robot7"));
  EXPECT_FALSE(matches("ro*t?", "robot"));
  EXPECT_TRUE(matches("*a*b*", "xxaxxbxx"));
  EXPECT_FALSE(matches("*a*b", "xbxa"));
}

TEST(Glob, Sets) {
  EXPECT_TRUE(matches("r[0-3x]", "r2"));
  EXPECT_TRUE(matches("r[0-3x]", "rx"));
  EXPECT_FALSE(matches("r[0-3x]", "r4"));
  EXPECT_TRUE(matches("r[!0-3]", "r4"));
  EXPECT_FALSE(matches("r[!0-3]", "r1"));
  EXPECT_TRUE(matches("[]]", "]"));
  EXPECT_TRUE(matches("[a-]", "-"));
}

TEST(Glob, FitsManyTexts) {
  const Glob glob("**r[a-c]*?");
  for (const char* text : {"rax", "xxrcyy", "rrb0"}) EXPECT_TRUE(glob.matches(text)) << text;
  for (const char* text : {"ra", "rdx", ""}) EXPECT_FALSE(glob.matches(text)) << text;
}

TEST(Glob, AnUnclosedSetIsText) {
  EXPECT_TRUE(matches("r[0", "r[0"));
  EXPECT_FALSE(matches("r[0", "r0"));
}

TEST(Glob, MaliciousPatternsAreFast) {
  std::string pattern;
  for (int i = 0; i < 100; ++i) pattern += "*a";
  EXPECT_FALSE(matches(pattern + "b", std::string(1000, 'a')));
}

}  // namespace
}  // namespace ziggurat::network
