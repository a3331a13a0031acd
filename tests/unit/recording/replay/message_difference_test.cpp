// SPDX-License-Identifier: MIT
#include "recording/replay/message_difference.h"

#include <gtest/gtest.h>

#include "ziggurat/v1/run.pb.h"

namespace ziggurat::replay {
namespace {

TEST(MessageDifference, NamesTheFirstFieldAndBothValues) {
  v1::Inputs a, b;
  EXPECT_FALSE(first_difference(a, b));
  for (v1::Inputs* each : {&a, &b}) {
    each->set_tick(4);
    for (const double v : {0.5, 1.5})
      each->mutable_commands()->mutable_joint_targets()->add_values(v);
  }
  EXPECT_FALSE(first_difference(a, b));
  b.mutable_commands()->mutable_joint_targets()->set_values(1, 0.1 + 0.2);
  const auto found = first_difference(a, b);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->field, "commands.joint_targets.values[1]");
  EXPECT_EQ(found->a, "1.5");
  EXPECT_EQ(found->b, "0.30000000000000004");
  EXPECT_EQ(
      first_difference("ziggurat.v1.Inputs", a.SerializeAsString(), b.SerializeAsString())->field,
      found->field);
}

TEST(MessageDifference, TellsWhatIsMissing) {
  v1::Inputs a, b;
  a.add_acts()->mutable_remove()->set_entity("box");
  auto found = first_difference(a, b);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->field, "acts[0]");
  EXPECT_EQ(found->b, "nothing");
  b.add_acts()->mutable_pause();
  found = first_difference(a, b);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->field, "acts[0].remove");
}

TEST(MessageDifference, IsNotFoundInUnknownTypesAndDamagedMessages) {
  EXPECT_FALSE(first_difference("other.Type", "a", "b"));
  EXPECT_FALSE(first_difference("ziggurat.v1.Inputs", "\xFF", "\xFE"));
}

}  // namespace
}  // namespace ziggurat::replay
