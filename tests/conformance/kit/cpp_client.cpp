// SPDX-License-Identifier: MIT
// A controller on the C++ library for the conformance kit: all motors at one speed, all it hears
// back.

#include <exception>
#include <iostream>

#include "ziggurat/ziggurat.h"

int main() {
  try {
    ziggurat::Session session(ziggurat::Options::from_environment());
    while (session.next()) {
      for (ziggurat::Robot& robot : session.robots()) {
        for (ziggurat::Joint& joint : robot.joints()) {
          if (joint.has_motor()) joint.set_target(1);
        }
        for (ziggurat::Radio& radio : robot.radios()) {
          for (const ziggurat::Bytes message : radio.received()) {
            if (radio.sends()) radio.send(message);
          }
        }
      }
    }
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
