#include "wire/json_values.h"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

namespace ziggurat::wire {
namespace {

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

}  // namespace

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

}  // namespace ziggurat::wire
