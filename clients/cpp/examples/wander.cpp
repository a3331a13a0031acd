// SPDX-License-Identifier: MIT
// A controller as a class, as ARGoS has them: drives straight on; near an obstacle it turns left.
// It does what docs/coming-from-argos/wander.lua does:
//   ziggurat run docs/coming-from-argos/nest.argos --controller wander=example_wander

#include <ziggurat/ziggurat.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

namespace {

constexpr double near = 0.1;  // reading of a sensor
constexpr int turn = 13;      // ticks that a turn takes

class Wander {
 public:
  explicit Wander(ziggurat::Robot& robot) : robot_(robot) {  // Init() and Reset()
    for (const auto& [name, value] : robot.params()) {
      if (name == "speed") speed_ = std::stod(value) / 100;
    }
  }

  void control_step() {
    const bool is_blocked = std::ranges::any_of(
        robot_.proximity_sensors(), [](const ziggurat::ProximitySensor& sensor) {
          return std::abs(sensor.angle().value_or(0)) < 1.2 && sensor.reading() > near;
        });
    if (is_blocked && left_to_turn_ == 0) left_to_turn_ = turn;
    if (left_to_turn_ > 0) {
      --left_to_turn_;
      robot_.wheels()->set_velocity(-speed_, speed_);
    } else {
      robot_.wheels()->set_velocity(speed_, speed_);
    }
  }

 private:
  ziggurat::Robot& robot_;
  double speed_ = 0;  // [m/s]
  int left_to_turn_ = 0;
};

}  // namespace

int main() try {
  ziggurat::Session session(ziggurat::Options::from_environment());
  std::vector<Wander> controllers;  // one for each robot of the session
  while (session.next()) {
    if (session.event() != ziggurat::Event::step) {
      controllers.clear();
      for (ziggurat::Robot& robot : session.robots()) controllers.emplace_back(robot);
    } else {
      for (Wander& controller : controllers) controller.control_step();
    }
  }  // Destroy()
} catch (const std::exception& error) {
  std::fprintf(stderr, "wander: %s\n", error.what());
  return 1;
}
