// SPDX-License-Identifier: MIT
// Any text, with a `{` in front, is read as a client's message in JSON and as a server's. A message
// that can be read must be the one that protobuf reads. It must also be writable as JSON, and
// readable again as the same kind of message.

#include <string>
#include <vector>

#include "receiver.h"
#include "wire/read_json.h"
#include "ziggurat/v1/json.h"
#include "ziggurat/v1/protocol.pb.h"

namespace {

using namespace ziggurat;
using fuzz::require;

/// Leaves out enumerations that are no value: those are the ones that we read from an unknown name,
/// which protobuf leaves out.
void drop_unknown_names(google::protobuf::Message& message) {
  const google::protobuf::Reflection& reflection = *message.GetReflection();
  std::vector<const google::protobuf::FieldDescriptor*> fields;
  reflection.ListFields(message, &fields);
  for (const auto* field : fields) {
    if (field->cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_ENUM) {
      if (!field->is_repeated() && reflection.GetEnumValue(message, field) == -1)
        reflection.ClearField(&message, field);
    } else if (field->cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_MESSAGE) {
      const int count = field->is_repeated() ? reflection.FieldSize(message, field) : 1;
      for (int i = 0; i < count; ++i) {
        drop_unknown_names(field->is_repeated()
                               ? *reflection.MutableRepeatedMessage(&message, field, i)
                               : *reflection.MutableMessage(&message, field));
      }
    }
  }
}

template <typename Message>
void rewrite(std::string_view text) {
  Message message, by_protobuf, again;
  if (!wire::read_json(text, message).empty()) return;
  if (v1::from_json(text, by_protobuf).empty()) {
    Message known = message;
    drop_unknown_names(known);
    drop_unknown_names(by_protobuf);
    require(known.SerializeAsString() == by_protobuf.SerializeAsString());
  }
  require(wire::read_json(v1::to_json(message), again).empty());
  require(again.message_case() == message.message_case());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string text(reinterpret_cast<const char*>(data), size);
  if (!text.starts_with('{')) text.insert(0, 1, '{');
  fuzz::receive(text);
  if (size % 8 == 0) rewrite<v1::ClientMessage>(text);
  if (size % 8 == 1) rewrite<v1::ServerMessage>(text);
  return 0;
}
