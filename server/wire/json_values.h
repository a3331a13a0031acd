#pragma once
// Values of JSON as values of a message's fields. Each function sets the field, or adds to it if it
// is repeated; false: the field can't have the value.

#include <google/protobuf/message.h>

#include <cstdint>
#include <string>

namespace ziggurat::wire {

/// A field of a message that is not itself a message.
struct FieldTarget {
  google::protobuf::Message& message;
  const google::protobuf::FieldDescriptor& field;
};

bool put(const FieldTarget& target, bool value);
bool put(const FieldTarget& target, std::int64_t value);
bool put(const FieldTarget& target, std::uint64_t value);
/// An integer's field takes it if it has no fraction.
bool put(const FieldTarget& target, double value);
/// A text, base64 of bytes, the name of an enumeration's value, or a number. An unknown name of an
/// enumeration's value is ignored.
bool put(const FieldTarget& target, const std::string& text);

}  // namespace ziggurat::wire
