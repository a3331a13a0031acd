#include "wire/read_json.h"

#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "wire/json_values.h"

namespace ziggurat::wire {
namespace {

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
