// SPDX-License-Identifier: MIT
#include "ziggurat/error.h"

#include <utility>

#include "text/printable.h"

namespace ziggurat {
namespace {

ProtocolError::Details printable(ProtocolError::Details details) {
  for (std::string* each : {&details.robot, &details.field, &details.holder})
    *each = text::printable_part(*each);
  return details;
}

}  // namespace

ConnectionError::ConnectionError(const std::string& message)
    : std::runtime_error(text::printable_part(message)) {}

ProtocolError::ProtocolError(const std::string& message, Details details)
    : std::runtime_error(text::printable_part(message)), details_(printable(std::move(details))) {}

}  // namespace ziggurat
