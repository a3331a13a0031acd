// SPDX-License-Identifier: MIT
// Drives the four-wheeled vehicle of scenes/vehicle.argos: sets the target speed of each wheel
// once, then logs the speeds that the encoders measure.
//
// The command of an <external_controller> in a scene starts it; or start it by hand:
//   ZIGGURAT_ENDPOINT=tcp://127.0.0.1:7400 example_vehicle

#include <ziggurat/ziggurat.h>

#include <array>
#include <cstdio>
#include <exception>

int main() try {
  ziggurat::Session session(ziggurat::Options::from_environment());

  // Ids are looked up once, before the loop.
  ziggurat::Robot& vehicle = session.robots().front();
  const std::array<ziggurat::Joint*, 4> wheels = {
      &vehicle.joint("base_wheel_bl"), &vehicle.joint("base_wheel_fl"),
      &vehicle.joint("base_wheel_br"), &vehicle.joint("base_wheel_fr")};

  // next() sends the values that were set in this tick and waits for the next tick.
  while (session.next()) {
    if (session.event() == ziggurat::Event::step) {
      char text[80];
      std::snprintf(text, sizeof(text), "wheel velocities: %.2f, %.2f, %.2f, %.2f",
                    wheels[0]->encoder(), wheels[1]->encoder(), wheels[2]->encoder(),
                    wheels[3]->encoder());
      vehicle.log(text);
    } else {                                                         // init or reset: tick 0
      for (ziggurat::Joint* wheel : wheels) wheel->set_target(1.0);  // [rad/s]
    }
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "vehicle: %s\n", error.what());
  return 1;
}
