// SPDX-License-Identifier: MIT
#include "wire/read_json.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace ziggurat::wire {
namespace {

/// A field of a message that is not itself a message.
struct FieldTarget {
  google::protobuf::Message& message;
  const google::protobuf::FieldDescriptor& field;
};

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

template <class Value>
using Setter = void (Reflection::*)(Message*, const FieldDescriptor*, Value) const;

template <class Value>
bool store(const FieldTarget& target, Value value, Setter<Value> set, Setter<Value> add) {
  const Reflection& reflection = *target.message.GetReflection();
  (reflection.*(target.field.is_repeated() ? add : set))(&target.message, &target.field,
                                                         std::move(value));
  return true;
}

/// @param value  of one of the 64-bit types
template <class Number>
bool put_integer(const FieldTarget& target, Number value) {
  switch (target.field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_INT32:
      return std::in_range<std::int32_t>(value) &&
             store(target, static_cast<std::int32_t>(value), &Reflection::SetInt32,
                   &Reflection::AddInt32);
    case FieldDescriptor::CPPTYPE_UINT32:
      return std::in_range<std::uint32_t>(value) &&
             store(target, static_cast<std::uint32_t>(value), &Reflection::SetUInt32,
                   &Reflection::AddUInt32);
    case FieldDescriptor::CPPTYPE_INT64:
      return std::in_range<std::int64_t>(value) &&
             store(target, static_cast<std::int64_t>(value), &Reflection::SetInt64,
                   &Reflection::AddInt64);
    case FieldDescriptor::CPPTYPE_UINT64:
      return std::in_range<std::uint64_t>(value) &&
             store(target, static_cast<std::uint64_t>(value), &Reflection::SetUInt64,
                   &Reflection::AddUInt64);
    case FieldDescriptor::CPPTYPE_ENUM:
      return std::in_range<int>(value) &&
             store(target, static_cast<int>(value), &Reflection::SetEnumValue,
                   &Reflection::AddEnumValue);
    default:
      return false;
  }
}

bool is_real(const FieldDescriptor& field) {
  return field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE ||
         field.cpp_type() == FieldDescriptor::CPPTYPE_FLOAT;
}

bool put_real(const FieldTarget& target, double value) {
  if (target.field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE) {
    return store(target, value, &Reflection::SetDouble, &Reflection::AddDouble);
  }
  const bool is_too_large =
      std::isfinite(value) && std::abs(value) > std::numeric_limits<float>::max();
  return !is_too_large &&
         store(target, static_cast<float>(value), &Reflection::SetFloat, &Reflection::AddFloat);
}

/// The whole text as a number.
template <class Number>
std::optional<Number> number_of(std::string_view text) {
  Number number{};
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || rest != end) return std::nullopt;
  return number;
}

bool put_real_text(const FieldTarget& target, std::string_view text) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (text == "NaN") return put_real(target, std::numeric_limits<double>::quiet_NaN());
  if (text == "Infinity") return put_real(target, infinity);
  if (text == "-Infinity") return put_real(target, -infinity);
  const auto number = number_of<double>(text);
  return number && std::isfinite(*number) && put_real(target, *number);
}

bool put_integer_text(const FieldTarget& target, std::string_view text) {
  if (const auto number = number_of<std::uint64_t>(text)) return put_integer(target, *number);
  const auto number = number_of<std::int64_t>(text);
  return number && put_integer(target, *number);
}

/// The six bits of each character of base64, of both alphabets; 64: none.
constexpr auto make_digits() {
  std::array<std::uint8_t, 256> digits{};
  digits.fill(64);
  std::uint8_t value = 0;
  for (const auto& [first, last] : {std::pair('A', 'Z'), {'a', 'z'}, {'0', '9'}}) {
    for (int each = first; each <= last; ++each) digits[static_cast<std::size_t>(each)] = value++;
  }
  digits['+'] = digits['-'] = 62;
  digits['/'] = digits['_'] = 63;
  return digits;
}

/// Bytes of a base64 text, with or without padding.
std::optional<std::string> bytes_of(std::string_view text) {
  static constexpr auto digits = make_digits();
  const bool is_padded = text.size() % 4 == 0;
  for (int i = 0; i < 2 && is_padded && text.ends_with('='); ++i) text.remove_suffix(1);
  if (text.size() % 4 == 1) return std::nullopt;
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int count = 0;  // of bits that are not written yet
  for (const char each : text) {
    const std::uint8_t digit = digits[static_cast<unsigned char>(each)];
    if (digit == 64) return std::nullopt;
    bits = (bits << 6 | digit) & 0xFFFF;
    if ((count += 6) < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xFF);
  }
  if ((bits & ((1U << count) - 1)) != 0) return std::nullopt;
  return bytes;
}

/// An unknown name is as an unknown number: what must not be left out is refused later.
bool put_enumeration(const FieldTarget& target, const std::string& name) {
  constexpr std::int64_t unknown = -1;
  const auto* value = target.field.enum_type()->FindValueByName(name);
  if (value != nullptr) return put_integer(target, std::int64_t{value->number()});
  return put_integer_text(target, name) || put_integer(target, unknown);
}

// Values of JSON as values of a message's fields. Each put() sets the field, or adds to it if it is
// repeated; false: the field can't have the value.

bool put(const FieldTarget& target, bool value) {
  return target.field.cpp_type() == FieldDescriptor::CPPTYPE_BOOL &&
         store(target, value, &Reflection::SetBool, &Reflection::AddBool);
}

bool put(const FieldTarget& target, std::int64_t value) {
  return is_real(target.field) ? put_real(target, static_cast<double>(value))
                               : put_integer(target, value);
}

bool put(const FieldTarget& target, std::uint64_t value) {
  return is_real(target.field) ? put_real(target, static_cast<double>(value))
                               : put_integer(target, value);
}

bool put(const FieldTarget& target, double value) {
  if (is_real(target.field)) return put_real(target, value);
  constexpr double beyond = 0x1p64;
  if (value != std::trunc(value) || value < -0x1p63 || value >= beyond) return false;
  return value < 0 ? put_integer(target, static_cast<std::int64_t>(value))
                   : put_integer(target, static_cast<std::uint64_t>(value));
}

bool put(const FieldTarget& target, const std::string& text) {
  if (target.field.type() == FieldDescriptor::TYPE_STRING) {
    return store(target, text, &Reflection::SetString, &Reflection::AddString);
  }
  if (target.field.type() == FieldDescriptor::TYPE_BYTES) {
    auto bytes = bytes_of(text);
    return bytes &&
           store(target, *std::move(bytes), &Reflection::SetString, &Reflection::AddString);
  }
  if (target.field.cpp_type() == FieldDescriptor::CPPTYPE_ENUM)
    return put_enumeration(target, text);
  return is_real(target.field) ? put_real_text(target, text) : put_integer_text(target, text);
}

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using nlohmann::json;

/// Puts what a parser finds into a message. What is in unknown fields is JSON, and nothing else is
/// asked of it.
class Reader final : public nlohmann::json_sax<json> {
 public:
  explicit Reader(Message& message) : root_(&message) {}

  std::string complaint;

  bool null() override {
    // Stands for a field that is not there.
    if (!is_in_list()) return true;
    return known() == nullptr || complain(fmt::format("'{}' has null as an element", name_));
  }
  bool boolean(bool value) override { return scalar(Is::boolean, value); }
  bool number_integer(number_integer_t value) override { return scalar(Is::number, value); }
  bool number_unsigned(number_unsigned_t value) override { return scalar(Is::number, value); }
  bool number_float(number_float_t value, const string_t&) override {
    return scalar(Is::number, value);
  }
  bool string(string_t& value) override { return scalar(Is::text, value); }
  bool binary(binary_t&) override { return false; }  // not in JSON

  bool start_object(std::size_t) override {
    Message* message = levels_.empty() ? root_ : nullptr;
    if (const FieldDescriptor* field = known()) {
      const bool is_message = field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
      if (!is_message) return complain(fmt::format("'{}' is an object", name_));
      if (!is_single_or_element()) return complain_list();
      if (!is_only_one_of_its_kind()) return false;
      Message* owner = levels_.back().message;
      const auto& reflection = *owner->GetReflection();
      message = field->is_repeated() ? reflection.AddMessage(owner, field)
                                     : reflection.MutableMessage(owner, field);
    }
    return push({message, nullptr, 0, false});
  }
  bool key(string_t& name) override {
    Level& level = levels_.back();
    level.field =
        level.message == nullptr ? nullptr : field_of(*level.message->GetDescriptor(), name);
    if (level.field == nullptr) return true;
    name_ = level.field->name();
    static_assert(sizeof(level.seen) == 8);
    const std::uint64_t bit = std::uint64_t{1} << (level.field->index() % 64);
    if ((level.seen & bit) != 0) return complain(fmt::format("'{}' stands there twice", name_));
    level.seen |= bit;
    return true;
  }
  bool end_object() override { return pop(); }

  bool start_array(std::size_t) override {
    const FieldDescriptor* field = known();
    if (levels_.empty()) return complain("it is a list");
    if (field != nullptr && (!field->is_repeated() || is_in_list())) {
      return complain(fmt::format("'{}' is a list{}", name_, is_in_list() ? " of lists" : ""));
    }
    return push({field == nullptr ? nullptr : levels_.back().message, field, 0, true});
  }
  bool end_array() override { return pop(); }

  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::detail::exception&) override {
    return complain(fmt::format("not JSON at byte {}", position));
  }

 private:
  enum class Is { boolean, number, text };
  struct Level {
    Message* message;              // of an object, or that has the list; null: unknown
    const FieldDescriptor* field;  // whose value comes next; null: unknown
    std::uint64_t seen;            // fields of the object, by index
    bool is_list;
  };

  static const FieldDescriptor* field_of(const Descriptor& type, const std::string& name) {
    if (const FieldDescriptor* field = type.FindFieldByCamelcaseName(name)) return field;
    return type.FindFieldByName(name);
  }
  const FieldDescriptor* known() const { return levels_.empty() ? nullptr : levels_.back().field; }
  bool is_in_list() const { return !levels_.empty() && levels_.back().is_list; }
  bool is_single_or_element() const { return !known()->is_repeated() || is_in_list(); }

  template <class Value>
  bool scalar(Is kind, const Value& value) {
    if (levels_.empty()) return complain("it is not an object");
    const FieldDescriptor* field = known();
    if (field == nullptr) return true;
    if (!is_single_or_element()) return complain_list();
    const auto type = field->cpp_type();
    if (type == FieldDescriptor::CPPTYPE_MESSAGE) {
      return complain(fmt::format("'{}' is not an object", name_));
    }
    if (type == FieldDescriptor::CPPTYPE_STRING && kind == Is::number) {
      return complain(fmt::format("'{}' is a number", name_));
    }
    const bool is_truth_value = type == FieldDescriptor::CPPTYPE_BOOL;
    if (is_truth_value != (kind == Is::boolean)) {
      return complain(is_truth_value ? fmt::format("'{}' is neither true nor false", name_)
                                     : fmt::format("'{}' is a truth value", name_));
    }
    if (!is_only_one_of_its_kind()) return false;
    return put({*levels_.back().message, *field}, value) ||
           complain(fmt::format("'{}' can't have that value", name_));
  }
  /// Whether no other field of the same oneof is set.
  bool is_only_one_of_its_kind() {
    const Message& owner = *levels_.back().message;
    const auto* choice = known()->real_containing_oneof();
    if (choice == nullptr || !owner.GetReflection()->HasOneof(owner, choice)) return true;
    return complain(fmt::format("it has '{}' beside another kind of {}", name_, choice->name()));
  }
  bool push(const Level& level) {
    if (levels_.size() == deepest_json) {
      return complain(fmt::format("it is nested more than {} deep", deepest_json));
    }
    levels_.push_back(level);
    return true;
  }
  bool pop() {
    levels_.pop_back();
    if (!levels_.empty() && known() != nullptr) name_ = known()->name();
    return true;
  }
  bool complain(std::string why) {
    if (complaint.empty()) complaint = std::move(why);
    return false;
  }
  bool complain_list() { return complain(fmt::format("'{}' is not a list", name_)); }

  Message* root_;
  std::string name_;  // of the last known field
  std::vector<Level> levels_;
};

}  // namespace

std::string read_json(std::string_view text, Message& message) {
  // nlohmann's parser takes it for the end of the text.
  if (const std::size_t nul = text.find('\0'); nul != text.npos)
    return fmt::format("not JSON at byte {}", nul + 1);
  Reader reader(message);
  const bool is_right =
      json::sax_parse(text.begin(), text.end(), &reader, json::input_format_t::json, true);
  if (is_right || !reader.complaint.empty()) return reader.complaint;
  return "not JSON";
}

}  // namespace ziggurat::wire
