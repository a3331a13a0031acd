// SPDX-License-Identifier: MIT
#include "reports/gate.h"

#include <gtest/gtest.h>

#include "text/numbers.h"
#include "words_of.h"

namespace ziggurat::reports {
namespace {

TEST(Gate, ReadsTimesSharesAndNumbers) {
  const auto gate = parse_gate("p99<2ms, misses<0.1%,late<5,p99.9 < 300us,max<1s,jitter<2us,run<4");
  ASSERT_EQ(gate.size(), 7U);
  EXPECT_EQ(gate[0].subject, Condition::Subject::p99);
  EXPECT_DOUBLE_EQ(gate[0].limit, 0.002);
  EXPECT_TRUE(gate[1].is_share);
  EXPECT_DOUBLE_EQ(gate[1].limit, 0.001);
  EXPECT_FALSE(gate[2].is_share);
  EXPECT_DOUBLE_EQ(gate[2].limit, 5);
  EXPECT_DOUBLE_EQ(gate[3].limit, 3e-4);
  EXPECT_DOUBLE_EQ(gate[4].limit, 1);
  EXPECT_DOUBLE_EQ(gate[5].limit, 2e-6);
  EXPECT_EQ(gate[6].subject, Condition::Subject::run);
  EXPECT_DOUBLE_EQ(gate[6].limit, 4);
}

TEST(Gate, NamesThePartThatIsWrong) {
  for (const char* text :
       {"", "p99", "p99<", "p99<2", "p99<2%", "p98<2ms", "misses<2ms", "p99>2ms", "p99<-1ms",
        "p99<nanms", "p99<2ms,,", "p99<2ms,", "p99<0x10ms", "misses<101%", "late<1e3%"}) {
    EXPECT_THROW(parse_gate(text), text::UsageError) << text;
  }
  for (const char* text : {"late<0", "misses<0%", "p99<0ms", "run<0.0", "max<0us"}) {
    EXPECT_TRUE(fails_with<text::UsageError>("is never met: nothing is below 0",
                                             [&] { parse_gate(text); }));
  }
  EXPECT_EQ(parse_gate("misses<100%")[0].limit, 1);
  EXPECT_TRUE(fails_with<text::UsageError>("'speed<3'", [&] { parse_gate("p99<2ms,speed<3"); }));
}

}  // namespace
}  // namespace ziggurat::reports
