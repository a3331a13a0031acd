#pragma once
// The cameras of a session's robots, and what they see.

#include <vector>

#include "ziggurat/session.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat {

/// Built once, from Welcome; the robots stay where they are.
struct Session::Cameras {
  void add(const v1::RobotDescription& description, Robot& robot);
  /// @throws std::runtime_error, saying what, if it is not what was announced
  void check(const v1::Observation& observation) const;
  /// Of a checked message, which stays unchanged until the next is read: readings point into it.
  void read(const v1::Observation& observation);

 private:
  static void read_leds(const std::vector<Camera*>& cameras,
                        std::vector<Camera::LedReading> Camera::*readings,
                        const google::protobuf::RepeatedField<std::uint32_t>& counts,
                        const google::protobuf::RepeatedField<std::uint32_t>& colors,
                        const double* center);
  void read_tags(const v1::Observation& observation);

  // Those that have the detector, or take pictures, in Welcome's order.
  std::vector<Camera*> leds_;
  std::vector<Camera*> directional_leds_;
  std::vector<Camera*> tags_;
  std::vector<Camera*> images_;
};

}  // namespace ziggurat
