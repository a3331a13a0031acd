// SPDX-License-Identifier: MIT
// A program that knows nothing of our types can decode every channel by its schema.

#include "channels/schema.h"

#include <google/protobuf/descriptor.pb.h>
#include <google/protobuf/dynamic_message.h>
#include <google/protobuf/util/json_util.h>

#include "shown_world.h"

namespace ziggurat::channels {
namespace {

/// The message as JSON, by nothing but the schema.
std::string to_json(const Schema& schema, const std::string& bytes) {
  google::protobuf::FileDescriptorSet set;
  EXPECT_TRUE(set.ParseFromString(schema.descriptors));
  google::protobuf::DescriptorPool pool;
  for (const auto& file : set.file()) {
    EXPECT_TRUE(pool.BuildFile(file)) << file.name();
  }
  const auto* type = pool.FindMessageTypeByName(schema.name);
  EXPECT_TRUE(type) << schema.name;
  if (!type) return {};
  google::protobuf::DynamicMessageFactory factory(&pool);
  const std::unique_ptr<google::protobuf::Message> message(factory.GetPrototype(type)->New());
  EXPECT_TRUE(message->ParseFromString(bytes)) << schema.name;
  std::string json;
  google::protobuf::util::MessageToJsonString(*message, &json);
  return json;
}

TEST(Schema, IsAllThatIsNeededToDecode) {
  testing::ShownWorld world;
  world.simulation.step();
  for (const Channel& channel : world.channels.list()) {
    if (pace_of(channel.kind) == Pace::event || channel.kind == Kind::radio) continue;
    const auto messages = world.encode(channel.topic);
    ASSERT_EQ(messages.size(), 1u) << channel.topic;
    to_json(*channel.schema, messages[0].content->bytes());
  }
  const Channel& poses = *world.find("/poses");
  const std::string json = to_json(*poses.schema, world.encode("/poses")[0].content->bytes());
  EXPECT_NE(json.find("\"tick\":\"1\""), std::string::npos) << json;
  EXPECT_NE(json.find("\"generation\":\"1\""), std::string::npos) << json;
}

TEST(Schema, HasNoRepeatedBytes) {
  testing::ShownWorld world;
  world.simulation.step();
  const Schema& schema = *world.find("/robots/arm/command")->schema;
  EXPECT_EQ(schema.descriptors.find("tag_payloads"), std::string::npos);
  const std::string json = to_json(schema, world.encode("/robots/arm/command")[0].content->bytes());
  EXPECT_NE(json.find("\"tick\":\"1\""), std::string::npos) << json;
}

TEST(Schema, HasOnlyTheTypesThatAreUsed) {
  testing::ShownWorld world;
  EXPECT_LT(world.find("/robots/arm/observation")->schema->descriptors.size(), 2500u);
  EXPECT_LT(world.find("/poses")->schema->descriptors.size(), 800u);
}

}  // namespace
}  // namespace ziggurat::channels
