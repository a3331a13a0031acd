// SPDX-License-Identifier: MIT
#include "outputs/rays.h"

#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <sstream>

#include "file_text.h"
#include "ziggurat/v1/recording.pb.h"

namespace ziggurat::outputs {
namespace {

TEST(Rays, HasALinePerRay) {
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

TEST(Rays, HasALinePerFrustumWithItsCameraAndCorners) {
  const auto path = scratch("jsonl");
  world::Layout layout;
  layout.robots.resize(2);
  layout.robots[0].id = "r0";
  layout.robots[0].cameras = {0, 1};
  layout.robots[1].id = "r1";
  layout.robots[1].cameras = {1, 1};
  layout.cameras.resize(2);
  layout.cameras[1].id = "rear";
  world::State state;
  state.tick = 4;
  state.frusta.resize(1);
  state.frusta[0].camera = 1;
  for (int i = 0; i < 8; ++i) state.frusta[0].corners[i] = math::Vector3(i, 10 + i, 20 + i);
  Rays rays(path, layout);
  rays.write(state);
  rays.close();
  v1::RayLine line;
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(text_of(path), &line).ok());
  EXPECT_EQ(line.kind(), "frustum");
  EXPECT_EQ(line.robot(), "r1");
  EXPECT_EQ(line.camera(), "rear");
  ASSERT_EQ(line.corners_size(), 24);
  EXPECT_EQ(line.corners(0), 0);
  EXPECT_EQ(line.corners(22), 17);
  EXPECT_EQ(line.corners(23), 27);
}

}  // namespace
}  // namespace ziggurat::outputs
