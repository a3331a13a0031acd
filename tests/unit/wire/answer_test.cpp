// SPDX-License-Identifier: MIT
#include "wire/answer.h"

#include <gtest/gtest.h>

#include "wire/outbox.h"
#include "ziggurat/v1/json.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {
namespace {

std::string sent(const Outbox& outbox) {
  std::string bytes(outbox.size(), '\0');
  outbox.write(reinterpret_cast<std::uint8_t*>(bytes.data()));
  return bytes;
}

TEST(Answer, IsTheResponseWithANumberOfItsOwn) {
  Status status;
  status.tick = 12;
  status.scene = "a \"scene\"";
  Outbox source, outbox;
  source.response(0, status);
  Answer answer(source.message());
  for (const std::uint64_t number : {std::uint64_t{0}, std::uint64_t{7}, ~std::uint64_t{0}}) {
    for (const Encoding encoding : {Encoding::binary, Encoding::json, Encoding::binary}) {
      source.response(number, status);
      outbox.response(number, answer);
      outbox.encode(encoding);
      v1::ServerMessage message;
      const std::string bytes = sent(outbox);
      ASSERT_TRUE(encoding == Encoding::json ? v1::from_json(bytes, message).empty()
                                             : message.ParseFromString(bytes));
      EXPECT_EQ(message.SerializeAsString(), source.message().SerializeAsString());
    }
  }
  outbox.heartbeat(3);
  outbox.encode(Encoding::binary);
  EXPECT_EQ(sent(outbox), outbox.message().SerializeAsString()) << "the answer is over";
}

TEST(Answer, AFaultIsOne) {
  Fault fault;
  fault.code = ErrorCode::unknown_entity;
  Outbox source;
  source.response(0, fault);
  Answer answer(source.message());
  v1::ServerMessage message;
  ASSERT_TRUE(message.ParseFromString(answer.bytes(5, Encoding::binary)));
  EXPECT_EQ(message.response().id(), 5U);
  EXPECT_EQ(message.response().error().code(), v1::Error::UNKNOWN_ENTITY);
}

}  // namespace
}  // namespace ziggurat::wire
