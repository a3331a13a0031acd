// SPDX-License-Identifier: MIT
#include "wire/messages.h"

#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {

const char* to_string(ErrorCode code) {
  return v1::Error::Code_Name(static_cast<v1::Error::Code>(code)).c_str();
}

}  // namespace ziggurat::wire
