#include "run/gate_option.h"

#include <gtest/gtest.h>

#include <string>

#include "text/numbers.h"

namespace ziggurat::run {
namespace {

bool is_refused(const std::string& gate, const GateContext& context) {
  try {
    check_gate(reports::parse_gate(gate), context);
  } catch (const text::UsageError&) {
    return true;
  }
  return false;
}

TEST(GateOption, ConditionsThatAreAlwaysMetAreRefused) {
  std::vector<network::Config::Deadline> deadlines(2);
  EXPECT_TRUE(is_refused("p99<1s,misses<1%", {deadlines, false, true}));
  EXPECT_TRUE(is_refused("run<2", {deadlines, false, true}));
  EXPECT_FALSE(is_refused("misses<1%", {deadlines, true, true}))
      << "a client may ask for a deadline";
  EXPECT_TRUE(is_refused("late<1", {deadlines, true, false}));
  EXPECT_FALSE(is_refused("late<1", {deadlines, false, true}));
  EXPECT_FALSE(is_refused("p99<1s,max<2s,jitter<1s", {deadlines, false, false}));
  deadlines[1].policy = {scene::DeadlineAction::hold, 50, 0};
  EXPECT_FALSE(is_refused("misses<1%,run<2", {deadlines, false, false}));
}

}  // namespace
}  // namespace ziggurat::run
