#pragma once
// The wheels and turrets of a session's robots: what they read and what is commanded of them.

#include <vector>

#include "settings.h"
#include "ziggurat/session.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat {

/// Built once, from Welcome; the robots stay where they are, and so do the arrays that their
/// handles point into.
struct Session::Driving {
  Driving(const v1::Welcome& welcome, std::vector<Robot>& robots);
  Driving(const Driving&) = delete;
  Driving& operator=(const Driving&) = delete;

  /// @throws std::runtime_error, saying what, if it is not what was announced
  void check(const v1::Observation& observation) const;
  void read(const v1::Observation& observation);  ///< of a checked message
  void write(v1::Command& command) const;         ///< adds what was set since sent()
  void sent();                                    ///< after the command was
  void repeat();                                  ///< everything is sent again with the next
  void reset();                                   ///< to what it was in the beginning

 private:
  Settings<double> velocities_;  // left and right of each
  Settings<TurretMode> modes_;
  Settings<double> rotations_;
  Settings<double> speeds_;
  std::vector<Wheels*> wheels_;   // that measure
  std::vector<Turret*> turrets_;  // that measure
};

}  // namespace ziggurat
