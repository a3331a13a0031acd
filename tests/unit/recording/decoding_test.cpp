// SPDX-License-Identifier: MIT
#include "recording/decoding.h"

#include <google/protobuf/descriptor.pb.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "../long_runs.h"
#include "foxglove/schemas.pb.h"
#include "ziggurat/v1/channels.pb.h"
#include "ziggurat/v1/extent.h"
#include "ziggurat/v1/recording.pb.h"
#include "ziggurat/v1/run.pb.h"

namespace ziggurat::recording {
namespace {

using google::protobuf::Message;
constexpr std::size_t no_bound = ~std::size_t{0} / 4;

/// Memory that this process holds for objects [bytes].
std::size_t allocated() {
  const struct mallinfo2 info = ::mallinfo2();
  return info.uordblks + info.hblkhd;
}

/// A type and a piece of a message of it, which may stand in it many times.
struct Bomb {
  const char* name;
  const Message& type;
  std::string piece;
};

std::vector<Bomb> bombs() {
  using namespace std::string_literals;
  const auto& world = v1::World::default_instance();
  const auto& inputs = v1::Inputs::default_instance();
  std::vector<Bomb> all{
      {"empty acts", inputs, "\x22\0"s},
      {"pauses", inputs, "\x22\x02\x3a\0"s},
      {"unknown numbers", inputs, "\x78\x01"s},
      {"unknown texts", inputs, "\x7a\0"s},
      {"a number as text", inputs, "\x0a\0"s},
      {"acts as numbers", inputs, "\x20\0"s},
      {"radio messages", inputs, "\x2a\x02\x5a\0"s},
      {"contacts", v1::Contacts::default_instance(), "\x18\x01"s},
      {"packed contacts", v1::Contacts::default_instance(), "\x1a\x04\1\1\1\1"s},
      {"kinds of rays", v1::Rays::default_instance(), "\x1a\x08\0\0\0\0\0\0\0\0"s},
      {"maps", v1::RobotObservation::default_instance(), "\x0a\0"s},
      {"transforms", foxglove::FrameTransforms::default_instance(), "\x0a\0"s},
      {"entities of the scene", foxglove::SceneUpdate::default_instance(), "\x12\0"s}};
  for (char tag = 12; tag < 16; ++tag)
    all.push_back({"parts of the world", world, {static_cast<char>(tag << 3 | 2), '\0'}});
  for (int tag = 16; tag < (long_runs::is_slow ? 17 : 27); ++tag) {
    all.push_back({"more parts of the world",
                   world,
                   {static_cast<char>((tag << 3 | 2) | 0x80), static_cast<char>(tag >> 4), '\0'}});
  }
  return all;
}

std::string repeated(const std::string& piece, std::size_t bytes) {
  std::string all;
  all.reserve(bytes + piece.size());
  while (all.size() < bytes) all += piece;
  return all;
}

/// Standard error is for our own messages, as objects of JSON where that is asked for.
TEST(Decoding, PrintsNothingAboutTextThatIsNoUtf8) {
  v1::RunStart start;
  testing::internal::CaptureStderr();
  const auto fault = decode("\x0a\x02\xff\xfe", start);  // a scene of two bytes
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(fault, "is damaged");
}

TEST(Decoding, TheMemoryThatIsFoundOutIsEnough) {
  for (const Bomb& bomb : bombs()) {
    const std::string bytes = repeated(bomb.piece, 600'000);
    const std::size_t counted = v1::decoded_size(bytes, *bomb.type.GetDescriptor(), no_bound);
    const std::unique_ptr<Message> message(bomb.type.New());
    const std::size_t before = allocated();
    ASSERT_TRUE(message->ParseFromString(bytes)) << bomb.name;
    const std::size_t taken = allocated() - before;
    EXPECT_GE(counted, taken) << bomb.name;
    if (std::string_view("maps") == bomb.name || taken == 0)
      continue;  // the same key in all; sanitizers tell nothing
    EXPECT_LT(counted, 15 * taken + 1'000'000) << bomb.name;
  }
}

TEST(Decoding, AMessageOfManySmallPartsIsNotDecoded) {
  for (const Bomb& bomb : bombs()) {
    const Bound most = bound_of(*bomb.type.GetDescriptor());
    const std::string bytes = repeated(bomb.piece, most.bytes - 10);
    const std::unique_ptr<Message> message(bomb.type.New());
    const std::size_t before = allocated();
    const auto fault = decode(bytes, *message);
    EXPECT_LE(allocated(), before + most.memory) << bomb.name;
    if (most.memory / most.bytes < 10) {
      EXPECT_TRUE(fault) << bomb.name;
    }
  }
}

TEST(Decoding, ALongMessageIsNotDecoded) {
  v1::Inputs inputs;
  const std::string bytes(bound_of_inputs.bytes + 1, '\0');
  const auto fault = decode(bytes, inputs);
  ASSERT_TRUE(fault);
  EXPECT_NE(fault->find("33554433 bytes"), std::string::npos) << *fault;
}

TEST(Decoding, GroupsAreNotDecoded) {
  v1::Inputs inputs;
  EXPECT_TRUE(decode(std::string("\x7b\x08\x01\x7c", 4), inputs))
      << "what is in a group would be kept as unknown";
  EXPECT_FALSE(decode(std::string("\x08\x01", 2), inputs));
  EXPECT_EQ(inputs.epoch(), 1u);
}

TEST(Decoding, MessagesInMessagesWithoutEndAreRefused) {
  google::protobuf::DescriptorProto type;  // one that may stand in itself, as none of ours
  std::string bytes;                       // from its end
  for (int i = 0; i < 200'000; ++i) {
    std::string head(1, '\x1a');
    for (std::size_t size = bytes.size(), more = 1; more; size >>= 7) {
      more = size > 0x7F ? 0x80 : 0;
      head += static_cast<char>((size & 0x7F) | more);
    }
    bytes.append(head.rbegin(), head.rend());
  }
  std::ranges::reverse(bytes);
  EXPECT_TRUE(decode(bytes, type));
}

/// The largest world that the bounds must hold.
TEST(Decoding, AWorldOfFortyThousandBodiesIsFarBelowTheBounds) {
  constexpr int bodies = 40'000;
  v1::World world;
  foxglove::SceneUpdate scene;
  v1::ExactState state;
  v1::Inputs inputs;
  foxglove::FrameTransforms transforms;
  for (int i = 0; i < bodies; ++i) {
    auto& entity = *world.add_entities();
    entity.set_id("body" + std::to_string(i));
    entity.set_link_count(1);
    for (int k = 0; k < 3; ++k) entity.add_origin_position(k);
    for (int k = 0; k < 4; ++k) entity.add_origin_orientation(k);
    auto& link = *world.add_links();
    link.set_frame("body" + std::to_string(i));
    link.set_mass(1);
    for (int k = 0; k < 3; ++k) link.mutable_box()->add_size(1);
    auto& shown = *scene.add_entities();
    shown.set_id(entity.id());
    shown.mutable_timestamp()->set_seconds(1);
    auto& cube = *shown.add_cubes();
    cube.mutable_pose()->mutable_position()->set_x(1);
    cube.mutable_pose()->mutable_orientation()->set_w(1);
    cube.mutable_size()->set_x(1);
    cube.mutable_color()->set_r(1);
    for (int k = 0; k < 13; ++k) state.add_values(k);
    auto& move = *inputs.add_acts()->mutable_move();
    move.set_entity(entity.id());
    for (int k = 0; k < 7; ++k) k < 3 ? move.add_position(k) : move.add_orientation(k);
    for (int k = 0; k < 20; ++k) inputs.mutable_commands()->mutable_joint_targets()->add_values(k);
    auto& sent = *inputs.mutable_commands()->add_radio_messages();
    sent.set_payload("hello");
    auto& transform = *transforms.add_transforms();
    transform.mutable_timestamp()->set_seconds(1);
    transform.set_child_frame_id(entity.id());
    transform.mutable_translation()->set_x(1);
    transform.mutable_rotation()->set_w(1);
  }
  for (const Message* each :
       std::initializer_list<const Message*>{&world, &scene, &state, &inputs, &transforms}) {
    const Bound most = bound_of(*each->GetDescriptor());
    const std::string bytes = each->SerializeAsString();
    EXPECT_LT(bytes.size(), most.bytes / 2) << each->GetTypeName();
    EXPECT_LT(v1::decoded_size(bytes, *each->GetDescriptor(), no_bound), most.memory / 2)
        << each->GetTypeName();
    const std::unique_ptr<Message> decoded(each->New());
    EXPECT_FALSE(decode(bytes, *decoded));
    EXPECT_EQ(decoded->SerializeAsString(), bytes);
  }
}

TEST(Decoding, MemoryOfALargeMessageIsGivenBack) {
  v1::Inputs inputs;
  for (int i = 0; i < 100'000; ++i) inputs.add_acts()->mutable_pause();
  EXPECT_FALSE(decode("", inputs));
  EXPECT_LT(inputs.SpaceUsedLong(), 2'000u);
}

}  // namespace
}  // namespace ziggurat::recording
