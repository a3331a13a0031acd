#include "recording/readings.h"

#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <sstream>
#include <vector>

#include "file_text.h"
#include "ziggurat/v1/recording.pb.h"

namespace ziggurat::recording {
namespace {

world::Layout layout() {
  world::Layout layout;
  layout.entities = {{"r0", {0, 1}, true}, {"r1", {1, 1}, true}};
  layout.links = {{"base", 0}, {"base", 1}};
  layout.robots.resize(2);
  layout.robots[0] = {"r0", 0, 0, {}, {0, 2}, {0, 1}};
  layout.robots[1] = {"r1", 1, 0, {}, {2, 1}, {1, 1}};
  layout.joint_sensors = {{"right"}, {"left"}, {"arm"}};
  layout.joint_actuators = {{"right"}, {"arm"}};
  return layout;
}

TEST(Readings, IsALinePerRobotInSceneOrderWithNamesOfTheProto) {
  const auto path = scratch("jsonl");
  const auto robots = layout();
  Readings readings(path, robots);
  readings.write({3, 300'000'000, {0.5, 0.25, 0}}, {{1.5, -2}});
  readings.close();
  EXPECT_EQ(text_of(path), R"({"tick":"3","time_s":0.3,"robot":"r0",)"
                           R"("observation":{"joint_encoders":{"left":0.25,"right":0.5}},)"
                           R"("command":{"joint_targets":{"right":1.5}}})"
                           "\n"
                           R"({"tick":"3","time_s":0.3,"robot":"r1",)"
                           R"("observation":{"joint_encoders":{"arm":0}},)"
                           R"("command":{"joint_targets":{"arm":-2}}})"
                           "\n");
}

TEST(Readings, ReadBackAsTheSameMessage) {
  const auto path = scratch("jsonl");
  const auto robots = layout();
  Readings readings(path, robots);
  readings.write({1, 100'000'000, {0.1 + 0.2, 1.0 / 3, 5e-324}}, {{1e22, -0.0}});
  readings.close();
  std::istringstream lines(text_of(path));
  std::vector<v1::Reading> read;
  for (std::string line; std::getline(lines, line);) {
    ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(line, &read.emplace_back()).ok())
        << line;
  }
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].observation().joint_encoders().at("right"), 0.1 + 0.2);
  EXPECT_EQ(read[0].observation().joint_encoders().at("left"), 1.0 / 3);
  EXPECT_EQ(read[1].observation().joint_encoders().at("arm"), 5e-324);
  EXPECT_EQ(read[0].command().joint_targets().at("right"), 1e22);
}

}  // namespace
}  // namespace ziggurat::recording
