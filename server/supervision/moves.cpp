#include "supervision/moves.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "wire/fault.h"

namespace ziggurat::supervision {

using wire::ErrorCode;

std::variant<math::Pose, wire::Fault> pose_of_move(const math::Pose& now,
                                                   const wire::Request& request) {
  constexpr double farthest = 1e6;  // [m], as in scenes
  const auto is_near = [](double value) { return std::abs(value) <= farthest; };
  if (request.position.size() != 3 || !std::ranges::all_of(request.position, is_near)) {
    return wire::make_fault(
        ErrorCode::bad_value, "move.position",
        "A position must be three numbers x, y, z from -1e6 to 1e6 metres.");
  }
  math::Pose pose = now;
  pose.position = {request.position[0], request.position[1], request.position[2]};
  if (request.orientation.empty()) return pose;
  const auto& q = request.orientation;
  const double norm = std::sqrt(std::inner_product(q.begin(), q.end(), q.begin(), 0.0));
  if (q.size() != 4 || !std::isfinite(norm) || norm < 1e-6) {
    return wire::make_fault(
        ErrorCode::bad_value, "move.orientation",
        "An orientation must be a quaternion w, x, y, z, finite and not zero.");
  }
  pose.orientation = math::Quaternion(q[0], q[1], q[2], q[3]).normalized();
  return pose;
}

}  // namespace ziggurat::supervision
