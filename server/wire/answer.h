// SPDX-License-Identifier: MIT
#pragma once
// A Response that is made once and sent to many, each with its own number.

#include <cstdint>
#include <optional>
#include <string>

#include "wire/messages.h"

namespace ziggurat::v1 {
class ServerMessage;
}

namespace ziggurat::wire {

class Answer {
 public:
  /// @param message  a Response whose number is 0
  explicit Answer(const v1::ServerMessage& message);

  /// The whole message.
  std::string bytes(std::uint64_t request, Encoding encoding);

 private:
  std::string content_;  // of the Response, in binary form
  std::string text_;     // behind its number, in JSON; empty: not made yet
};

}  // namespace ziggurat::wire
