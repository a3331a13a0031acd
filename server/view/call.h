#pragma once
// Requests of a viewer with the token.

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "wire/request.h"

namespace ziggurat::view {

/// A parameter and its value, or the value that is wanted.
struct Parameter {
  std::string name;
  std::variant<std::monostate, bool, double, std::string> value;  ///< nothing: no such parameter
};

/// Answered once, by ViewerServer::answer() or refuse().
struct ViewerCall {
  std::uint64_t viewer = 0;
  std::uint32_t service = 0, number = 0;
  wire::Request request;        ///< without kind: it is about the speed
  std::optional<double> speed;  ///< simulated seconds per second of wall time; 0: without pacing
};

}  // namespace ziggurat::view
