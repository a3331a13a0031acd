// Drives, and turns left while a sensor in front sees something near.

#include <ziggurat/ziggurat.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>

constexpr double speed = 0.1;  // [m/s]

/// The greatest reading of the rays within 60 degrees of straight ahead: 0 is nothing, 1 is
/// contact.
double ahead(const ziggurat::Robot& robot) {
  constexpr double widest = 1.05;  // [rad]
  double greatest = 0;
  for (const auto& sensor : robot.proximity_sensors()) {
    if (std::abs(sensor.angle().value_or(0)) < widest)
      greatest = std::max(greatest, sensor.reading());
  }
  return greatest;
}

int main() try {
  ziggurat::Session session(ziggurat::Options::from_environment());
  ziggurat::Robot& robot = session.robots().front();
  while (session.next()) {
    const bool is_near = ahead(robot) > 0;
    robot.wheels()->set_velocity(is_near ? -speed / 2 : speed, is_near ? speed / 2 : speed);
    for (ziggurat::Led& led : robot.leds())
      led.set_color(is_near ? ziggurat::Color{255, 0, 0} : ziggurat::Color{0, 255, 0});
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "controller: %s\n", error.what());
  return 1;
}
