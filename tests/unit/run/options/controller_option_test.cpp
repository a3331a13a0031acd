// SPDX-License-Identifier: MIT
#include "run/options/controller_option.h"

#include <gtest/gtest.h>

#include "text/numbers.h"

namespace ziggurat::run {
namespace {

TEST(RestartOption, ANumberForAllOrForOneController) {
  EXPECT_EQ(to_restart("3").controller, "");
  EXPECT_EQ(to_restart("3").times, 3U);
  EXPECT_EQ(to_restart("a=b=2").controller, "a=b");
  EXPECT_EQ(to_restart("a=b=2").times, 2U);
}

TEST(RestartOption, WrongTextsAreRefused) {
  for (const char* text :
       {"", "robot", "robot=", "=2", "robot=-1", "robot=1.5", "robot=99999999"}) {
    EXPECT_THROW(to_restart(text), text::UsageError) << text;
  }
}

TEST(RestartOption, ThoseThatNameAControllerWin) {
  scene::Scene scene;
  scene.controllers.resize(2);
  scene.controllers[0].id = "robot";
  scene.controllers[1].id = "block";
  EXPECT_EQ(restarts_of({}, scene), (std::vector<unsigned>{0, 0}));
  EXPECT_EQ(restarts_of({to_restart("robot=5"), to_restart("1")}, scene),
            (std::vector<unsigned>{5, 1}));
  EXPECT_THROW(restarts_of({to_restart("unknown=1")}, scene), text::UsageError);
}

}  // namespace
}  // namespace ziggurat::run
