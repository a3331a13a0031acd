// SPDX-License-Identifier: MIT
#include "ziggurat/v1/extent.h"

#include <google/protobuf/message.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <unordered_map>

namespace ziggurat::v1 {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;

constexpr int most_levels = 100;  // of messages in messages: protobuf decodes no more

/// Takes a varint from the front; none if there is none.
std::optional<std::uint64_t> take_varint(std::string_view& bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes.size() && i < 10; ++i) {
    const auto byte = static_cast<unsigned char>(bytes[i]);
    value |= std::uint64_t{byte & 0x7FU} << (7 * i);
    if (byte >= 0x80) continue;
    bytes.remove_prefix(i + 1);
    return value;
  }
  return std::nullopt;
}

/// Takes the value of a field; its content if it has a length. None at the end of what can be read.
std::optional<std::string_view> take_value(std::string_view& bytes, unsigned wire_type) {
  std::uint64_t size = 0;
  switch (wire_type) {
    case 0:
      return take_varint(bytes) ? std::optional(std::string_view()) : std::nullopt;
    case 1:
      size = 8;
      break;
    case 2: {
      const auto length = take_varint(bytes);
      if (!length) return std::nullopt;
      size = *length;
      break;
    }
    case 5:
      size = 4;
      break;
    default:  // the ends of a group
      return std::string_view();
  }
  if (size > bytes.size()) return std::nullopt;
  const auto content = bytes.substr(0, static_cast<std::size_t>(size));
  bytes.remove_prefix(content.size());
  return content;
}

/// As a number stands in a message when it is no list.
unsigned wire_type_of(const FieldDescriptor& number) {
  switch (number.type()) {
    case FieldDescriptor::TYPE_DOUBLE:
    case FieldDescriptor::TYPE_FIXED64:
    case FieldDescriptor::TYPE_SFIXED64:
      return 1;
    case FieldDescriptor::TYPE_FLOAT:
    case FieldDescriptor::TYPE_FIXED32:
    case FieldDescriptor::TYPE_SFIXED32:
      return 5;
    default:
      return 0;
  }
}

/// Whether numbers of a list take as many bytes in the message as in memory.
bool has_fixed_size(const FieldDescriptor& number) { return wire_type_of(number) != 0; }

struct Field {
  const FieldDescriptor* known;  ///< null: the type has no such field
  unsigned wire_type;
  std::string_view content;  ///< if it has a length

  bool is_message() const {
    return known != nullptr && wire_type == 2 &&
           known->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
  }
};

/// The sum over all fields of what each weighs, without the fields of messages in it.
template <class Weigh>
std::size_t sum(std::string_view bytes, const Descriptor& type, std::size_t most, int levels,
                Weigh& weigh) {
  constexpr std::uint64_t largest_number = (1U << 29) - 1;
  std::size_t all = 0;
  while (!bytes.empty() && all <= most) {
    const auto tag = take_varint(bytes);
    if (!tag || *tag >> 3 > largest_number) break;
    const auto wire_type = static_cast<unsigned>(*tag & 7);
    const auto content = take_value(bytes, wire_type);
    if (!content) break;
    const FieldDescriptor* known = Weigh::needs_field(wire_type)
                                       ? type.FindFieldByNumber(static_cast<int>(*tag >> 3))
                                       : nullptr;
    const Field field{known, wire_type, *content};
    all += weigh(field);
    if (all <= most && levels > 0 && field.is_message()) {
      all += sum(*content, *known->message_type(), most - all, levels - 1, weigh);
    }
  }
  return all;
}

struct Count {
  static bool needs_field(unsigned wire_type) { return wire_type == 2; }

  std::size_t operator()(const Field& field) const {
    if (field.known == nullptr) return 1;
    // Each byte may be a number of a list, which takes four bytes of memory or more. Text is looked
    // at character by character.
    const bool has_numbers = field.known->is_packable() && !has_fixed_size(*field.known);
    const bool is_text = field.known->type() == FieldDescriptor::TYPE_STRING;
    return 1 + (has_numbers || is_text ? field.content.size() / bytes_per_field : 0);
  }
};

/// Memory of each field [bytes].
class Memory {
 public:
  static bool needs_field(unsigned) { return true; }

  std::size_t operator()(const Field& field) {
    constexpr unsigned is_group = 3,
                       ends_group = 4;  // none of the types has any: what is in one stays unknown
    if (field.wire_type == is_group || field.wire_type == ends_group)
      return std::numeric_limits<std::size_t>::max() / 2;
    const std::size_t text = sizeof(std::string) + field.content.size() + 2 * block;
    const std::size_t unknown = growth * 16 + block + text;
    if (field.known == nullptr) return unknown;
    switch (field.known->cpp_type()) {
      case FieldDescriptor::CPPTYPE_MESSAGE:
        return field.is_message() ? message(*field.known) : unknown;
      case FieldDescriptor::CPPTYPE_STRING:
        return field.wire_type == 2 ? text + place : unknown;
      default:
        if (field.wire_type == 2 && field.known->is_packable()) return growth * 8 * numbers(field);
        if (field.wire_type != wire_type_of(*field.known)) return unknown;
        return field.known->is_repeated() ? growth * 8 : 0;
    }
  }

 private:
  static constexpr std::size_t block =
      24;  // what the system needs for each piece of memory, and its rounding
  static constexpr std::size_t growth =
      3;  // a list that grows has up to three times its size, while it is copied
  static constexpr std::size_t place = growth * 8;  // of a pointer in a list

  std::size_t message(const FieldDescriptor& field) {
    return size_of(*field.message_type()) + block + (field.is_map() ? 3 * place : place);
  }

  static std::size_t numbers(const Field& field) {
    if (has_fixed_size(*field.known)) return (field.content.size() + 7) / 8;
    return static_cast<std::size_t>(std::ranges::count_if(
        field.content, [](char byte) { return static_cast<unsigned char>(byte) < 0x80; }));
  }

  /// Size of an empty message [bytes].
  std::size_t size_of(const Descriptor& type) {
    constexpr std::size_t unknown = 256;
    const auto [at, is_new] = sizes_.try_emplace(&type, unknown);
    if (!is_new) return at->second;
    const auto* empty = google::protobuf::MessageFactory::generated_factory()->GetPrototype(&type);
    if (empty != nullptr) at->second = empty->SpaceUsedLong();
    return at->second;
  }

  std::unordered_map<const Descriptor*, std::size_t> sizes_;
};

}  // namespace

std::size_t count_fields(std::string_view bytes, const Descriptor& type, std::size_t most) {
  Count count;
  return sum(bytes, type, most, most_levels, count);
}

std::size_t decoded_size(std::string_view bytes, const Descriptor& type, std::size_t most) {
  Memory memory;
  return sum(bytes, type, most, most_levels, memory);
}

}  // namespace ziggurat::v1
