#include "run/client_scopes.h"

#include <gtest/gtest.h>

namespace ziggurat::run {
namespace {

TEST(Scopes, ThatMeanNoRobotOfTheSceneAreDoubted) {
  scene::Scene scene;
  scene.controllers.resize(1);
  scene.controllers[0].id = "wander";
  world::Layout layout;
  layout.robots.resize(2);
  layout.robots[0].id = "scout1";
  layout.robots[1].id = "r7";
  network::ClientKey fits{"k", network::all_roles, "Alice", {{"scout*", "r7"}, {"w*"}}};
  network::ClientKey misspelt{
      "key of 40 characters", network::all_roles, "", {{"zzz*", "r7", "r8"}, {"wonder"}}};
  EXPECT_EQ(doubts_of({fits, misspelt}, scene, layout),
            (std::vector<std::string>{"--curve-clients: robots=zzz*,r8 of the key key of 40 "
                                      "characters means no robot of the scene",
                                      "--curve-clients: controllers=wonder of the key key of 40 "
                                      "characters means no controller of the scene"}));
}

}  // namespace
}  // namespace ziggurat::run
