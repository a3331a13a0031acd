// SPDX-License-Identifier: MIT
#include "outputs/json.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/stubs/strutil.h>
#include <google/protobuf/util/json_util.h>
#include <google/protobuf/wrappers.pb.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace ziggurat::outputs {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

constexpr std::size_t longest_piece = std::size_t{1}
                                      << 20;  // of text that is escaped at once [bytes]
constexpr std::size_t longest_buffer = std::size_t{16} << 20;  // [bytes]

/// Such as times.
bool is_protobufs_own(const google::protobuf::Descriptor& type) {
  return type.file()->package() == "google.protobuf";
}

// Writer in place of protobuf's MessageToJsonString. That function takes a thousand bytes for each
// field, defaults included. It walks maps in an order that differs from run to run.
class Writer {
 public:
  explicit Writer(OutputFile& to) : file_(to), to_(to.buffer()) {}

  void write(const Message& message) {
    const auto& type = *message.GetDescriptor();
    if (is_protobufs_own(type)) return append(as_protobuf(message));
    to_.push_back('{');
    bool is_first = true;
    for (const FieldDescriptor* field : in_order(type)) {
      // Absent messages and members of a oneof, as optional fields are, stay absent.
      if (field->has_presence() && !message.GetReflection()->HasField(message, field)) continue;
      fmt::format_to(std::back_inserter(to_), "{}\"{}\":", is_first ? "" : ",", field->name());
      is_first = false;
      write_field(message, *field);
    }
    to_.push_back('}');
  }

 private:
  void append(std::string_view text) { to_.append(text); }

  /// As protobuf's JSON has them: in the order of the .proto, then optional ones and times by their
  /// numbers.
  const std::vector<const FieldDescriptor*>& in_order(const google::protobuf::Descriptor& type) {
    std::vector<const FieldDescriptor*>& fields = orders_[&type];
    if (!fields.empty()) return fields;
    for (int i = 0; i < type.field_count(); ++i) fields.push_back(type.field(i));
    const auto place = [](const FieldDescriptor* field) {
      const bool is_last = field->has_optional_keyword() ||
                           (field->message_type() && is_protobufs_own(*field->message_type()));
      return std::pair(is_last, is_last ? field->number() : field->index());
    };
    std::ranges::sort(fields, {}, place);
    return fields;
  }

  void write_field(const Message& message, const FieldDescriptor& field) {
    if (!field.is_repeated()) return write_value(message, field, -1);
    if (field.is_map()) return write_map(message, field);
    const int size = message.GetReflection()->FieldSize(message, &field);
    to_.push_back('[');
    for (int i = 0; i < size; ++i) {
      if (i > 0) to_.push_back(',');
      write_value(message, field, i);
      if (to_.size() > longest_buffer) file_.flush();
    }
    to_.push_back(']');
  }

  /// All have texts as keys.
  void write_map(const Message& message, const FieldDescriptor& field) {
    const auto& values = *field.message_type()->map_value();
    const auto& keys = *field.message_type()->map_key();
    std::vector<const Message*> entries;
    const int size = message.GetReflection()->FieldSize(message, &field);
    for (int i = 0; i < size; ++i)
      entries.push_back(&message.GetReflection()->GetRepeatedMessage(message, &field, i));
    const auto key = [&](const Message* entry) {
      return entry->GetReflection()->GetString(*entry, &keys);
    };
    std::ranges::sort(entries, {}, key);
    to_.push_back('{');
    for (const Message* entry : entries) {
      if (entry != entries.front()) to_.push_back(',');
      write_text(key(entry));
      to_.push_back(':');
      write_value(*entry, values, -1);
    }
    to_.push_back('}');
  }

  /// @param index  of an element; -1: the field is no array
  void write_value(const Message& message, const FieldDescriptor& field, int index) {
    const Reflection& of = *message.GetReflection();
    const auto get = [&](auto single, auto repeated) {
      return index < 0 ? (of.*single)(message, &field) : (of.*repeated)(message, &field, index);
    };
    const auto to = std::back_inserter(to_);
    switch (field.cpp_type()) {
      case FieldDescriptor::CPPTYPE_INT32:
        fmt::format_to(to, "{}", get(&Reflection::GetInt32, &Reflection::GetRepeatedInt32));
        break;
      case FieldDescriptor::CPPTYPE_UINT32:
        fmt::format_to(to, "{}", get(&Reflection::GetUInt32, &Reflection::GetRepeatedUInt32));
        break;
      case FieldDescriptor::CPPTYPE_INT64:
        fmt::format_to(to, "\"{}\"", get(&Reflection::GetInt64, &Reflection::GetRepeatedInt64));
        break;
      case FieldDescriptor::CPPTYPE_UINT64:
        fmt::format_to(to, "\"{}\"", get(&Reflection::GetUInt64, &Reflection::GetRepeatedUInt64));
        break;
      case FieldDescriptor::CPPTYPE_BOOL:
        append(get(&Reflection::GetBool, &Reflection::GetRepeatedBool) ? "true" : "false");
        break;
      case FieldDescriptor::CPPTYPE_DOUBLE:
        write_number(get(&Reflection::GetDouble, &Reflection::GetRepeatedDouble),
                     google::protobuf::SimpleDtoa);
        break;
      case FieldDescriptor::CPPTYPE_FLOAT:
        write_number(get(&Reflection::GetFloat, &Reflection::GetRepeatedFloat),
                     google::protobuf::SimpleFtoa);
        break;
      case FieldDescriptor::CPPTYPE_ENUM:
        write_enumerator(*field.enum_type(),
                         get(&Reflection::GetEnumValue, &Reflection::GetRepeatedEnumValue));
        break;
      case FieldDescriptor::CPPTYPE_STRING:
        write_string(message, field, index);
        break;
      case FieldDescriptor::CPPTYPE_MESSAGE:
        write(index < 0 ? of.GetMessage(message, &field)
                        : of.GetRepeatedMessage(message, &field, index));
        break;
    }
  }

  template <class T>
  void write_number(T value, std::string (*digits)(T)) {
    if (std::isfinite(value)) return append(digits(value));
    append(std::isnan(value) ? "\"NaN\"" : value > 0 ? "\"Infinity\"" : "\"-Infinity\"");
  }

  void write_enumerator(const google::protobuf::EnumDescriptor& type, int number) {
    const auto* known = type.FindValueByNumber(number);
    known ? fmt::format_to(std::back_inserter(to_), "\"{}\"", known->name())
          : fmt::format_to(std::back_inserter(to_), "{}", number);
  }

  void write_string(const Message& message, const FieldDescriptor& field, int index) {
    std::string empty;
    const Reflection& of = *message.GetReflection();
    const std::string& value = index < 0
                                   ? of.GetStringReference(message, &field, &empty)
                                   : of.GetRepeatedStringReference(message, &field, index, &empty);
    if (field.type() == FieldDescriptor::TYPE_STRING) return write_text(value);
    std::string text;
    google::protobuf::Base64Escape(value, &text);
    fmt::format_to(std::back_inserter(to_), "\"{}\"", text);
  }

  void write_text(std::string_view text) {
    to_.push_back('"');
    while (!text.empty()) {
      std::size_t size = std::min(text.size(), longest_piece);
      // Between two characters: the others' bytes begin with the bits 10.
      while (size < text.size() && size > longest_piece - 4 &&
             (static_cast<unsigned char>(text[size]) & 0xC0U) == 0x80U)
        --size;
      write_piece(text.substr(0, size));
      text.remove_prefix(size);
      if (to_.size() > longest_buffer) file_.flush();
    }
    to_.push_back('"');
  }

  /// Without quotation marks.
  void write_piece(std::string_view text) {
    const auto is_plain = [](char c) {
      return c >= ' ' && c <= '~' && c != '"' && c != '\\' && c != '<' && c != '>';
    };
    if (std::ranges::all_of(text, is_plain)) return append(text);
    google::protobuf::StringValue value;
    value.set_value(text.data(), text.size());
    const std::string escaped = as_protobuf(value);
    append(std::string_view(escaped).substr(1, escaped.size() - 2));
  }

  static std::string as_protobuf(const Message& message) {
    std::string text;
    const auto status = google::protobuf::util::MessageToJsonString(message, &text);
    if (!status.ok()) throw WriteError("a line has no JSON form: " + status.ToString());
    return text;
  }

  OutputFile& file_;
  fmt::memory_buffer& to_;
  std::unordered_map<const google::protobuf::Descriptor*, std::vector<const FieldDescriptor*>>
      orders_;
};

}  // namespace

void write_json(const Message& message, OutputFile& to) { Writer(to).write(message); }

}  // namespace ziggurat::outputs
