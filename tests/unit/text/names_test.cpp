#include "text/names.h"

#include <gtest/gtest.h>

#include <vector>

namespace ziggurat::text {
namespace {

TEST(Closest, IsTheCandidateThatWasProbablyMeant) {
  const std::vector<std::string> names{"--ticks", "--trace", "--max-scene-size"};
  EXPECT_EQ(closest("--tikcs", names), "--ticks");
  EXPECT_EQ(closest("--max-scene", names), "--max-scene-size") << "a beginning is near";
  EXPECT_EQ(closest("--xyzzy", names), "");
  EXPECT_EQ(closest("--ticks", {}), "");
}

}  // namespace
}  // namespace ziggurat::text
