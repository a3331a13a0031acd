// SPDX-License-Identifier: MIT
#include "recording/replay/replay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "recorded_run.h"
#include "recording/replay/difference.h"
#include "recording/replay/recording_file.h"
#include "words_of.h"

namespace ziggurat::replay {
namespace {

using testing::eventful_run;
using testing::OwnWorld;
using testing::Recording;

/// Number of states that are the same, from the first on.
std::size_t same_states(const Recording& recording) {
  OwnWorld world;
  Replay replay = world.replay(recording);
  std::size_t count = 0;
  while (replay.advance() && replay.is_same()) ++count;
  return count;
}

std::string error_of(const Recording& recording) {
  return words_of<RecordingError>([&] { same_states(recording); });
}

TEST(Replay, RepeatsCommandsMovesSpawnsRemovalsAndResets) {
  const Recording recording = eventful_run();
  ASSERT_GT(recording.inputs.size(), 20u);
  EXPECT_EQ(same_states(recording), recording.inputs.size());
}

TEST(Replay, FindsTheEntityOfANameThatIsUsedAgain) {
  const std::string box =
      R"(<box id="b" size=".1,.1,.1" movable="true" mass="1"><body position="-2,0,1"/></box>)";
  testing::Recorder run;
  run.spawn(box);
  run.snapshot("one");
  run.remove("b");
  run.spawn(box);
  run.step();
  run.remove("b");
  run.step();
  run.restore("one");
  run.remove("b");
  run.spawn(box);
  run.step();
  EXPECT_EQ(same_states(run.recording), run.recording.inputs.size());
  run.recording.inputs.front().add_acts()->mutable_remove()->set_entity("c");
  EXPECT_NE(error_of(run.recording).find("there is no entity 'c'"), std::string::npos);
}

TEST(Replay, RepeatsSnapshotsAndRestores) {
  testing::Recorder run;
  run.simulation().commands().joint_targets.at(0) = 1;
  for (int i = 0; i < 5; ++i) run.step();
  run.snapshot("before");
  run.simulation().commands().joint_targets.at(0) = -1;
  for (int i = 0; i < 4; ++i) run.step();
  run.restore("before");
  run.simulation().commands().joint_targets.at(0) = 0.5;
  for (int i = 0; i < 4; ++i) run.step();
  EXPECT_EQ(same_states(run.recording), run.recording.inputs.size());
  run.recording.inputs.front().add_acts()->mutable_restore()->set_name("other");
  EXPECT_NE(error_of(run.recording).find("no snapshot"), std::string::npos);
}

/// Shows recorded poses. Acts are applied also where a world that did not move has no free place.
TEST(Replay, ShowsRecordedPosesWithoutSimulating) {
  testing::Recorder run;
  for (int i = 0; i < 3; ++i) run.step();
  math::Pose away;
  away.position = {2, 2, 0.1};
  run.move("high", away);
  run.snapshot("before");
  run.spawn(
      R"(<box id="new" size=".2,.2,.2" movable="true" mass="1"><body position="0.05,0,0.5"/></box>)");
  for (int i = 0; i < 4; ++i) run.step();
  run.remove("low");
  run.step();
  run.restore("before");
  for (int i = 0; i < 2; ++i) run.step();
  run.reset(7);
  run.step();

  OwnWorld world, other;
  std::size_t at = 0;
  Replay shown = world.replay(run.recording);
  shown.show([&] { return &run.recording.links[at]; });
  Replay repeated = other.replay(run.recording);
  for (; shown.advance(); ++at) {
    ASSERT_TRUE(repeated.advance() && repeated.is_same());
    const world::State &a = world.simulation.state(), &b = other.simulation.state();
    ASSERT_FALSE(first_difference(a.links, b.links)) << at;
    ASSERT_EQ(a.time_ns, b.time_ns);
    ASSERT_EQ(a.origins.size(), b.origins.size());
    for (std::size_t i = 0; i < a.origins.size(); ++i) {
      ASSERT_EQ(a.is_absent(i), b.is_absent(i)) << at;
      if (a.is_absent(i)) continue;
      ASSERT_LT((a.origins[i].position - b.origins[i].position).norm(), 1e-12) << at;
      ASSERT_LT(a.origins[i].orientation.angularDistance(b.origins[i].orientation), 1e-7) << at;
    }
  }
  EXPECT_EQ(at, run.recording.inputs.size());
}

TEST(Replay, PosesThatDoNotFitAreRefused) {
  const auto error_with = [](const std::vector<world::LinkState>* links) -> std::string {
    const Recording recording = eventful_run();
    OwnWorld world;
    Replay replay = world.replay(recording);
    replay.show([&] { return links; });
    return words_of<RecordingError>([&] { replay.advance(); });
  };
  EXPECT_NE(error_with(nullptr).find("no poses in /state"), std::string::npos);
  std::vector<world::LinkState> links = eventful_run().links.front();
  EXPECT_EQ(error_with(&links), "");
  links[1].velocity.x() = std::nan("");
  EXPECT_NE(error_with(&links).find("is not finite"), std::string::npos);
  links.pop_back();
  EXPECT_NE(error_with(&links).find("poses of 3 links"), std::string::npos);
}

TEST(Replay, GivesTheSameCommandsBeforeEachStep) {
  const Recording recording = eventful_run();
  OwnWorld world;
  Replay replay = world.replay(recording);
  ASSERT_TRUE(replay.advance());
  replay.act();
  EXPECT_EQ(world.simulation.commands().joint_targets.at(0), 0);
  EXPECT_EQ(world.simulation.commands().radio_messages.entries.size(), 1u);
  ASSERT_TRUE(replay.advance());
  replay.act();
  EXPECT_EQ(world.simulation.commands().joint_targets.at(0), 0.3);
}

TEST(Replay, FindsTheFirstStateThatDiffers) {
  Recording recording = eventful_run();
  auto& targets = *recording.inputs[4].mutable_commands()->mutable_joint_targets();
  targets.set_values(0, targets.values(0) + 1e-9);
  EXPECT_EQ(same_states(recording), 5u);

  OwnWorld world;
  Replay replay = world.replay(recording);
  while (replay.advance() && replay.is_same()) continue;
  EXPECT_EQ(replay.inputs().tick(), 5u);
  const auto found = first_difference(recording.links[5], world.simulation.state().links);
  ASSERT_TRUE(found);
  EXPECT_EQ(world.simulation.layout().links[found->link].id, "arm");
  EXPECT_EQ(found->field, "position.x");
  EXPECT_NE(found->a, found->b);
  EXPECT_NEAR(found->a, found->b, 1e-8);
}

TEST(Replay, RefusesInputsThatThisWorldCannotHaveHad) {
  const Recording good = eventful_run();
  Recording bad = good;
  bad.inputs[3].mutable_commands()->mutable_joint_targets()->clear_values();
  EXPECT_EQ(error_of(bad),
            "the recording's inputs of tick 3: the array joint_targets has 0 values; "
            "the world has 1 joint actuators");
  bad = good;
  bad.inputs[2].clear_commands();
  EXPECT_EQ(error_of(bad),
            "the recording's inputs of tick 2: they have no commands, and yet there "
            "is a next tick");
  bad = good;
  bad.inputs.erase(bad.inputs.begin() + 3);
  EXPECT_EQ(error_of(bad), "the recording's inputs of tick 4: the tick 3 was expected");
  bad = good;
  bad.inputs[1].add_acts()->mutable_remove()->set_entity("ghost");
  EXPECT_EQ(error_of(bad), "the recording's inputs of tick 1: there is no entity 'ghost'");
  bad = good;
  bad.inputs[1].add_acts()->mutable_move()->set_entity("low");
  EXPECT_EQ(error_of(bad), "the recording's inputs of tick 1: 'low' is moved to no position");
  auto& move = *bad.inputs[1].mutable_acts(0)->mutable_move();
  for (int i = 0; i < 3; ++i) move.add_position(0.5);
  for (int i = 0; i < 4; ++i) move.add_orientation(1);
  EXPECT_NE(error_of(bad).find("no unit quaternion"), std::string::npos);
  bad = good;
  bad.inputs[1].add_acts();
  EXPECT_NE(error_of(bad).find("cannot repeat"), std::string::npos);
  bad = good;
  bad.inputs[1].add_acts()->mutable_reset();
  EXPECT_NE(error_of(bad).find("seed 0"), std::string::npos);
}

TEST(Replay, SetsJointsAgain) {
  testing::Recorder run;
  run.set_joint("r", {"hinge", 1.25, -3});
  for (int i = 0; i < 3; ++i) run.step();
  run.snapshot("here");
  run.set_joint("r", {"hinge", -0.5, 0});
  run.step();
  run.restore("here");
  run.step();
  EXPECT_EQ(same_states(run.recording), run.recording.inputs.size());

  Recording bad = run.recording;
  auto& set = *bad.inputs[0].mutable_acts(0)->mutable_set_joint();
  set.set_position(std::nan(""));
  EXPECT_EQ(error_of(bad),
            "the recording's inputs of tick 0: a joint cannot be set: The position of joint "
            "'hinge' of 'r' is nan; "
            "it must be from -1e+06 to 1e+06 rad.");
  set.set_joint("knee");
  EXPECT_NE(error_of(bad).find("'r' has no joint 'knee'; write one of 'hinge'."), std::string::npos)
      << error_of(bad);
  set.set_entity("ghost");
  EXPECT_EQ(error_of(bad), "the recording's inputs of tick 0: there is no entity 'ghost'");
}

TEST(Replay, SpawnsReadNoFileFromTheDisk) {
  Recording bad = eventful_run();
  bad.inputs[1].add_acts()->mutable_spawn()->set_xml(
      R"(<prototype id="x"><body position="5,5,1"/><links ref="l"><link id="l" geometry="hull" mass="1">)"
      R"(<hull file="hosts.obj"/></link></links></prototype>)");
  EXPECT_NE(error_of(bad).find("not in the recording"), std::string::npos) << error_of(bad);
}

TEST(Replay, AllThatIsSpawnedHasABoundUntilAReset) {
  testing::Recorder run;
  const auto spawn = [&](int i) {
    const std::string xml =
        "<box id='s" + std::to_string(i) + "' size='.1,.1,.1' movable='false'><body position='5," +
        std::to_string(i) + ",1'/><!--" + std::string(1'000'000, 'x') + "--></box>";
    run.inputs().add_acts()->mutable_spawn()->set_xml(xml);
  };
  for (int i = 0; i < 66; ++i) spawn(i);
  run.inputs().add_acts()->mutable_reset()->set_seed(4);
  spawn(66);
  spawn(67);
  EXPECT_EQ(error_of(run.recording).find("larger than"), std::string::npos)
      << error_of(run.recording);
  spawn(0);
  for (int i = 100; i < 166; ++i) spawn(i);
  EXPECT_NE(
      error_of(run.recording).find("an entity cannot be spawned: spawn: the file is larger than"),
      std::string::npos)
      << error_of(run.recording);
}

}  // namespace
}  // namespace ziggurat::replay
