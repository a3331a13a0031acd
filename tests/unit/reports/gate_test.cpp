#include "reports/gate.h"

#include <gtest/gtest.h>

#include "text/numbers.h"

namespace ziggurat::reports {
namespace {

TEST(Gate, ReadsTimesSharesAndNumbers) {
  const auto gate = parse_gate("p99<2ms, misses<0.1%,late<5,p99.9 < 300us,max<1s");
  ASSERT_EQ(gate.size(), 5U);
  EXPECT_EQ(gate[0].subject, Condition::Subject::p99);
  EXPECT_DOUBLE_EQ(gate[0].limit, 0.002);
  EXPECT_TRUE(gate[1].is_share);
  EXPECT_DOUBLE_EQ(gate[1].limit, 0.001);
  EXPECT_FALSE(gate[2].is_share);
  EXPECT_DOUBLE_EQ(gate[2].limit, 5);
  EXPECT_DOUBLE_EQ(gate[3].limit, 3e-4);
  EXPECT_DOUBLE_EQ(gate[4].limit, 1);
}

TEST(Gate, NamesThePartThatIsWrong) {
  for (const char* text : {"", "p99", "p99<", "p99<2", "p99<2%", "p98<2ms", "misses<2ms", "p99>2ms",
                           "p99<-1ms", "p99<nanms", "p99<2ms,,"}) {
    EXPECT_THROW(parse_gate(text), text::UsageError) << text;
  }
  try {
    parse_gate("p99<2ms,speed<3");
    FAIL();
  } catch (const text::UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("'speed<3'"), std::string::npos);
  }
}

TEST(Gate, MeasuresInTheUnitOfTheLimit) {
  const Performance performance{.p99 = 0.0015, .misses = 2, .late = 7, .ticks = 1000};
  EXPECT_DOUBLE_EQ(measured(parse_gate("p99<2ms")[0], performance), 0.0015);
  EXPECT_DOUBLE_EQ(measured(parse_gate("misses<0.1%")[0], performance), 0.002);
  EXPECT_DOUBLE_EQ(measured(parse_gate("misses<3")[0], performance), 2);
  EXPECT_DOUBLE_EQ(measured(parse_gate("late<1%")[0], performance), 0.007);
}

}  // namespace
}  // namespace ziggurat::reports
