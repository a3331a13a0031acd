#pragma once
// A short way to make a fault.

#include <string>
#include <utility>

#include "wire/messages.h"

namespace ziggurat::wire {

/// A fault that discards the message and leaves the session as it is.
inline Fault make_fault(ErrorCode code, std::string field, std::string message,
                        std::string robot = {}) {
  Fault fault;
  fault.code = code;
  fault.robot = std::move(robot);
  fault.field = std::move(field);
  fault.message = std::move(message);
  return fault;
}

}  // namespace ziggurat::wire
