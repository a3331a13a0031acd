#include "recording/rays.h"

#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <sstream>

#include "file_text.h"
#include "ziggurat/v1/recording.pb.h"

namespace ziggurat::recording {
namespace {

TEST(Rays, IsALinePerRayAndNothingWithoutAny) {
  const auto path = scratch("jsonl");
  world::Layout layout;
  layout.robots.resize(1);
  layout.robots[0].id = "r0";
  world::State state;
  state.tick = 4;
  state.time_ns = 2'000'000'000;
  Rays rays(path, layout);
  rays.write(state);
  state.rays = {{world::Ray::Kind::proximity, 0, {0, 0, 0}, {1, 2, 3}, true},
                {world::Ray::Kind::radio, 0, {4, 0, 0}, {5, 0, 0}, false}};
  rays.write(state);
  rays.close();
  std::istringstream lines(text_of(path));
  std::string text;
  v1::RayLine line;
  ASSERT_TRUE(std::getline(lines, text));
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(text, &line).ok());
  EXPECT_EQ(line.tick(), 4u);
  EXPECT_EQ(line.kind(), "proximity");
  EXPECT_EQ(line.robot(), "r0");
  EXPECT_EQ(line.end(2), 3);
  EXPECT_TRUE(line.hit());
  ASSERT_TRUE(std::getline(lines, text));
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(text, &line).ok());
  EXPECT_EQ(line.kind(), "radio");
  EXPECT_EQ(line.start(0), 4);
  EXPECT_FALSE(std::getline(lines, text));
}

}  // namespace
}  // namespace ziggurat::recording
