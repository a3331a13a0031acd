// SPDX-License-Identifier: MIT
#include "rerun/viewer_controls.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace ziggurat::rerun {
namespace {

using Kind = wire::Request::Kind;

/// A viewer of a replay, and what it was answered.
struct Viewer {
  ViewerControls controls;
  std::vector<network::Call> calls;
  std::vector<std::string> answers;
  std::uint64_t next = 1;
  bool is_there = true;

  Viewer() {
    controls.connect({[this] { return std::exchange(calls, {}); },
                      [this](const network::Call&) { return is_there; },
                      [this](const network::Call& call, std::uint64_t tick) {
                        answers.push_back(std::to_string(call.request.id) + " at " +
                                          std::to_string(tick));
                      },
                      [this](const network::Call& call, const std::string&) {
                        answers.push_back(std::to_string(call.request.id) + " refused");
                      }});
  }
  void ask(Kind kind, std::uint64_t tick, std::uint64_t ticks = 0) {
    network::Call call;
    call.request.kind = kind;
    call.request.id = next++;
    call.request.ticks = ticks;
    calls.push_back(call);
    controls.serve(tick);
  }
};

TEST(ViewerControls, PausesAndSteps) {
  Viewer viewer;
  viewer.ask(Kind::pause, 4);
  EXPECT_TRUE(viewer.controls.is_paused());
  viewer.ask(Kind::step, 4, 2);
  EXPECT_FALSE(viewer.controls.is_paused());
  viewer.controls.stepped(5);
  EXPECT_FALSE(viewer.controls.is_paused());
  viewer.controls.stepped(6);
  EXPECT_TRUE(viewer.controls.is_paused());
  viewer.ask(Kind::resume, 6);
  EXPECT_FALSE(viewer.controls.is_paused());
  EXPECT_EQ(viewer.answers, (std::vector<std::string>{"1 at 4", "2 at 6", "3 at 6"}));
}

TEST(ViewerControls, AStepThatIsInterruptedIsRefused) {
  Viewer viewer;
  viewer.ask(Kind::step, 0, 1);  // it is not paused
  viewer.ask(Kind::pause, 0);
  viewer.ask(Kind::step, 0, 100);
  viewer.controls.stepped(1);
  viewer.ask(Kind::pause, 1);
  EXPECT_TRUE(viewer.controls.is_paused());
  EXPECT_EQ(viewer.answers,
            (std::vector<std::string>{"1 refused", "2 at 0", "3 refused", "4 at 1"}));
}

TEST(ViewerControls, StepsEndWithTheirViewer) {
  Viewer viewer;
  viewer.ask(Kind::pause, 0);
  viewer.ask(Kind::step, 0, 100);
  viewer.controls.stepped(1);
  viewer.controls.serve(1);
  EXPECT_FALSE(viewer.controls.is_paused());
  viewer.is_there = false;
  viewer.controls.serve(1);
  EXPECT_TRUE(viewer.controls.is_paused());
  viewer.is_there = true;
  viewer.ask(Kind::step, 1, 1);
  viewer.controls.stepped(2);
  EXPECT_EQ(viewer.answers, (std::vector<std::string>{"1 at 0", "3 at 2"}));
}

TEST(ViewerControls, ChangesNothingOfTheWorld) {
  Viewer viewer;
  for (const Kind kind : {Kind::move, Kind::spawn, Kind::remove, Kind::reset}) viewer.ask(kind, 3);
  EXPECT_EQ(viewer.answers,
            (std::vector<std::string>{"1 refused", "2 refused", "3 refused", "4 refused"}));
  EXPECT_FALSE(viewer.controls.is_over());
  viewer.ask(Kind::shutdown, 3);
  EXPECT_TRUE(viewer.controls.is_over());
}

}  // namespace
}  // namespace ziggurat::rerun
