// Bodies that rebound and turn, with solver="newton". What rebounds straight is in sliding_test.cpp.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "newton_scene.h"

namespace ziggurat::physics {
namespace {

using namespace testing;

math::Quaternion random_turn(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  return math::Quaternion(w, x, y, z).normalized();
}

/// How far links turn in a substep over what their speeds before and after it say, at most.
class Turned {
 public:
  explicit Turned(const World& world) : before_(state_of(world)) {}

  void look(const World& world, double h) {
    const world::State now = state_of(world);
    for (std::size_t i = 0; i < now.links.size(); ++i) {
      const world::LinkState &one = before_.links[i], &other = now.links[i];
      const double speed = std::max(one.angular_velocity.norm(), other.angular_velocity.norm());
      const double angle = one.pose.orientation.angularDistance(other.pose.orientation);
      if (h * speed < 1) worst = std::max(worst, angle / (h * speed + 1e-3));
    }
    before_ = now;
  }
  double worst = 0;

 private:
  world::State before_;
};

// Two corners that strike the floor at different times in a substep asked for turns of up to 34 times that. It moves by v h,
// and to where it should be by up to |v1 - v0| h, at most twice the greater of the speeds.
TEST(NewtonRebound, TurnsABoxAsItsSpeedsSay) {
  std::mt19937 random(3);
  for (const double hz : {50, 100, 200, 500, 1000, 2000}) {
    for (int i = 0; i < 10; ++i) {
      World world(newton(true), 1 / hz);
      scene::Entity box = loose({{0, 0, 0.3}, random_turn(random)}, scene::Box{{0.033, 0.131, 0.086}}, 1);
      box.links[0].surface.restitution = 1;
      world.add(box);
      Turned turned(world);
      for (int n = 0; n < hz; ++n) {
        world.step();
        turned.look(world, 1 / hz);
      }
      EXPECT_LT(turned.worst, 3.03) << hz << ' ' << i;
    }
  }
}

}  // namespace
}  // namespace ziggurat::physics
