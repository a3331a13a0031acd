// SPDX-License-Identifier: MIT
// Any bytes are read as a client's message. A message that can be read must be writable as JSON and
// readable again. One input in eight tests this, as it takes ten times as long as the rest.

#include "receiver.h"
#include "ziggurat/v1/json.h"
#include "ziggurat/v1/protocol.pb.h"

namespace {

using namespace ziggurat;
using fuzz::require;

void rewrite(std::string_view bytes) {
  v1::ClientMessage message;
  if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) return;
  v1::ClientMessage again;
  require(v1::from_json(v1::to_json(message), again).empty());
  require(again.message_case() == message.message_case());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  fuzz::receive(bytes);
  if (size % 8 == 0) rewrite(bytes);
  return 0;
}
