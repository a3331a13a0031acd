// SPDX-License-Identifier: MIT
// A message for which there is no memory is its sender's error: each allocation is made to fail
// once.

#include <gtest/gtest.h>

#include <string>

#include "allocations/allocations.h"
#include "wire/inbox.h"
#include "ziggurat/v1/json.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {
namespace {

v1::ClientMessage command() {
  v1::ClientMessage message;
  v1::Command& command = *message.mutable_command();
  for (int i = 0; i < 1000; ++i) command.add_joint_targets(i);
  for (int i = 0; i < 20; ++i) command.add_tag_payloads(std::string(1000, 'x'));
  command.add_log()->set_text("a line that does not fit into a small string");
  return message;
}

v1::ClientMessage read_request() {
  v1::ClientMessage message;
  v1::ReadRequest& read = *message.mutable_request()->mutable_read();
  for (int i = 0; i < 20; ++i) read.add_entities(std::string(100, 'x'));
  return message;
}

TEST(Inbox, AMessageForWhichThereIsNoMemoryIsItsSendersError) {
  for (const std::string& message :
       {command().SerializeAsString(), read_request().SerializeAsString(), v1::to_json(command()),
        v1::to_json(read_request())}) {
    SCOPED_TRACE(message.substr(0, 20));
    EXPECT_NE(Inbox().parse(message), Inbox::Kind::malformed);  // protobuf has made its tables then
    std::size_t failures = 0;
    for (std::size_t index = 0;; ++index) {
      Inbox inbox;
      const std::size_t before = testing::allocations();
      Inbox::Kind kind = Inbox::Kind::malformed;
      {
        const testing::FailingAllocation failing(index);
        kind = inbox.parse(message);
      }
      if (kind == Inbox::Kind::malformed) {
        ++failures;
        EXPECT_EQ(inbox.complaint(), "there is no memory for it") << index;
        EXPECT_NE(inbox.parse(message), Inbox::Kind::malformed) << "the next message is taken";
      }
      if (testing::allocations() - before < index) break;  // it needed fewer
    }
    EXPECT_GT(failures, 5U);
  }
}

}  // namespace
}  // namespace ziggurat::wire
