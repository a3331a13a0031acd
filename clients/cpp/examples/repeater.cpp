// SPDX-License-Identifier: MIT
// The repeaters of Listing 2.8: each number received by one radio is sent by the other, plus one.
// One process controls all robots of the controller.

#include <cstdint>
#include <cstdio>
#include <exception>
#include <vector>

#include "ziggurat/ziggurat.h"

namespace {

/// The devices of a robot, looked up once.
struct Repeater {
  ziggurat::Radio& in;
  ziggurat::Radio& out;
  ziggurat::Led& led;
};

void send(ziggurat::Radio& radio, std::uint8_t token) { radio.send({&token, 1}); }

void step(Repeater& repeater) {
  const auto received = repeater.in.received();
  const bool has_token = !received.empty() && !received[0].empty();
  repeater.led.set_color(has_token ? ziggurat::Color{255, 0, 0} : ziggurat::Color{});
  if (has_token) send(repeater.out, static_cast<std::uint8_t>(received[0][0] + 1));
}

}  // namespace

int main() {
  try {
    ziggurat::Session session(ziggurat::Options::from_environment());
    std::vector<Repeater> repeaters;
    for (ziggurat::Robot& robot : session.robots()) {
      repeaters.push_back({robot.radio("radio_rx"), robot.radio("radio_tx"), robot.led("led")});
    }
    while (session.next()) {
      if (session.event() == ziggurat::Event::step) {
        for (Repeater& repeater : repeaters) step(repeater);
      } else {
        send(session.robot("repeater0").radio("radio_tx"), 0);
      }
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "repeater: %s\n", error.what());
    return 1;
  }
}
