// SPDX-License-Identifier: MIT
#include "recording/replay/message_difference.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/text_format.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "recording/decoding.h"
#include "ziggurat/v1/run.pb.h"

namespace ziggurat::replay {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

constexpr std::size_t longest = 200;  // of a value [characters]

/// @param index  of an element; -1: the field is no array
std::string text_of(const Message& message, const FieldDescriptor& field, int index) {
  const bool is_double = field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE;
  const auto& reflection = *message.GetReflection();
  if (is_double) {  // with all digits
    return fmt::format("{}", index < 0 ? reflection.GetDouble(message, &field)
                                       : reflection.GetRepeatedDouble(message, &field, index));
  }
  std::string text;
  if (field.cpp_type() ==
      FieldDescriptor::CPPTYPE_MESSAGE) {  // whose text can be far longer than it is
    text.resize(longest);
    google::protobuf::io::ArrayOutputStream first(text.data(), static_cast<int>(text.size()));
    google::protobuf::TextFormat::Print(index < 0
                                            ? reflection.GetMessage(message, &field)
                                            : reflection.GetRepeatedMessage(message, &field, index),
                                        &first);
    text.resize(static_cast<std::size_t>(first.ByteCount()));
  } else {
    google::protobuf::TextFormat::PrintFieldValueToString(message, &field, index, &text);
  }
  std::ranges::replace(text, '\n', ' ');
  return text.substr(0, longest);
}

std::optional<FieldDifference> with_prefix(std::optional<FieldDifference> inner,
                                           const std::string& prefix) {
  if (inner) inner->field = prefix + "." + inner->field;
  return inner;
}

std::optional<FieldDifference> difference_of_array(const Message& a, const Message& b,
                                                   const FieldDescriptor& field) {
  const auto& of_a = *a.GetReflection();
  const auto& of_b = *b.GetReflection();
  const int size_a = of_a.FieldSize(a, &field), size_b = of_b.FieldSize(b, &field);
  for (int i = 0; i < std::max(size_a, size_b); ++i) {
    const std::string name = fmt::format("{}[{}]", field.name(), i);
    if (i >= size_a) return FieldDifference{name, "nothing", text_of(b, field, i)};
    if (i >= size_b) return FieldDifference{name, text_of(a, field, i), "nothing"};
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      auto inner = first_difference(of_a.GetRepeatedMessage(a, &field, i),
                                    of_b.GetRepeatedMessage(b, &field, i));
      if (inner) return with_prefix(std::move(inner), name);
      continue;
    }
    std::string value_a = text_of(a, field, i), value_b = text_of(b, field, i);
    if (value_a != value_b) return FieldDifference{name, std::move(value_a), std::move(value_b)};
  }
  return std::nullopt;
}

std::optional<FieldDifference> difference_of(const Message& a, const Message& b,
                                             const FieldDescriptor& field) {
  if (field.is_repeated()) return difference_of_array(a, b, field);
  const auto& of_a = *a.GetReflection();
  const auto& of_b = *b.GetReflection();
  if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
    const bool has_a = of_a.HasField(a, &field), has_b = of_b.HasField(b, &field);
    if (has_a && has_b) {
      return with_prefix(first_difference(of_a.GetMessage(a, &field), of_b.GetMessage(b, &field)),
                         field.name());
    }
    if (!has_a && !has_b) return std::nullopt;
    return FieldDifference{field.name(), has_a ? text_of(a, field, -1) : "nothing",
                           has_b ? text_of(b, field, -1) : "nothing"};
  }
  std::string value_a = text_of(a, field, -1), value_b = text_of(b, field, -1);
  if (value_a == value_b) return std::nullopt;
  return FieldDifference{field.name(), std::move(value_a), std::move(value_b)};
}

}  // namespace

std::optional<FieldDifference> first_difference(const Message& a, const Message& b) {
  const auto& type = *a.GetDescriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    if (field.name() == "generation") continue;
    if (auto found = difference_of(a, b, field)) return found;
  }
  return std::nullopt;
}

std::optional<FieldDifference> first_difference(const std::string& type, std::string_view a,
                                                std::string_view b) {
  const auto* known =
      google::protobuf::DescriptorPool::generated_pool()->FindMessageTypeByName(type);
  if (!known) return std::nullopt;
  const Message* prototype =
      google::protobuf::MessageFactory::generated_factory()->GetPrototype(known);
  const std::unique_ptr<Message> of_a(prototype->New()), of_b(prototype->New());
  if (recording::decode(a, *of_a) || recording::decode(b, *of_b)) return std::nullopt;
  return first_difference(*of_a, *of_b);
}

void take_over(const v1::Commands& from, v1::Commands& held) {
  held.clear_radio_messages();
  held.clear_pushes();
  held.clear_floor_paints();
  held.clear_markers();
  std::vector<const FieldDescriptor*> changed;
  from.GetReflection()->ListFields(from, &changed);
  for (const FieldDescriptor* field : changed) held.GetReflection()->ClearField(&held, field);
  held.MergeFrom(from);
}

}  // namespace ziggurat::replay
