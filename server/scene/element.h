// SPDX-License-Identifier: MIT
#pragma once
// Elements of a scene file: their attributes and children as values, and a record of which of them
// were read, so that unknown ones are found without a list.

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <pugixml.hpp>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "scene/document.h"
#include "scene/names.h"
#include "scene/report.h"
#include "scene/values.h"
#include "scene/vocabulary.h"

namespace ziggurat::scene {

/// Zero, the identity, or nothing.
template <class T>
T blank() {
  if constexpr (requires { T::Zero(); }) {
    return T::Zero();
  } else if constexpr (requires { T::Identity(); }) {
    return T::Identity();
  } else {
    return T{};
  }
}

/// Words that a value may have, if it is one of a few.
template <class Read>
std::string example_of(const Read& read) {
  if constexpr (requires { read.words(); }) {
    return read.words();
  } else if constexpr (std::is_same_v<std::invoke_result_t<Read, std::string_view>, Value<bool>>) {
    return "true|false";
  } else {
    return "…";
  }
}

/// One element being read. Read its attributes and children, then call done().
class Element {
 public:
  Element(Document& document, pugi::xml_node node)
      : document_(&document), node_(node), name_(node.name()) {}

  /// As written, or of an old word of the dialect the one that it is read as.
  std::string_view name() const { return name_; }
  /// The first text in it; then it has been read.
  std::string_view take_text() { return any_text_ = true, node_.text().get(); }
  Location where() const;
  Report& report() const { return document_->report(); }

  /// Location of an attribute's value, or of the element if it has none of that name.
  Location where(const char* attribute) const;
  bool has(const char* attribute) const;
  /// Its value as it is written, without reading it; empty if there is none of that name.
  friend std::string_view written(const Element& element, const char* attribute);

  /// Result type of a reader of values.
  template <class Read>
  using ValueOf = std::variant_alternative_t<0, std::invoke_result_t<Read, std::string_view>>;

  /// The attribute's value, or nothing if it is missing or wrong; a wrong one is a fault.
  template <class Read>
  std::optional<ValueOf<Read>> optional(const char* attribute, Read read) {
    tell<Read>(attribute, read, Need::optional);
    return take(attribute, read);
  }

  /// The same, without a record of it in the vocabulary.
  template <class Read>
  std::optional<ValueOf<Read>> take(const char* attribute, Read read) {
    const std::optional<std::string> text = take(attribute);
    if (!text) return std::nullopt;
    auto value = read(std::string_view(*text));
    if (const Wrong* wrong = std::get_if<1>(&value)) {
      fault_at(attribute, wrong->text);
      return std::nullopt;
    }
    return std::get<0>(std::move(value));
  }

  /// The same with a default.
  template <class Read>
  ValueOf<Read> optional(const char* attribute, Read read, ValueOf<Read> fallback) {
    tell<Read>(attribute, read, Need::optional, &fallback);
    return take(attribute, read).value_or(std::move(fallback));
  }

  /// The attribute's value; a missing or wrong one is a fault and gives `fallback`.
  template <class Read>
  ValueOf<Read> required(const char* attribute, Read read,
                         ValueOf<Read> fallback = blank<ValueOf<Read>>());

  /// Checks an attribute that has no effect here, and reports that.
  template <class Read>
  void without_effect(const char* attribute, Read read, std::string_view why) {
    tell<Read>(attribute, read, Need::without_effect);
    if (!has(attribute)) return;
    take(attribute, read);
    report().notice(where(attribute),
                    fmt::format("{} of <{}> has no effect here: {}", attribute, name(), why));
  }

  /// Records what an attribute may be, if somebody wants to know.
  /// @param usual  its default; null: none
  template <class Read>
  void tell(const char* attribute, const Read& read, Need need,
            const ValueOf<Read>* usual = nullptr) const {
    if (Vocabulary* vocabulary = document_->vocabulary()) {
      add(element_at(*vocabulary, path()), attribute, asked_for(read, need, usual));
    }
  }

  /// All attributes, trimmed, whatever their names: for <params>.
  std::vector<std::pair<std::string, std::string>> all_attributes();

  /// The child of that name, if there is one; a second one is a notice.
  std::optional<Element> child(const char* name);
  /// The same; none is a fault.
  std::optional<Element> required_child(const char* name);
  /// All children, for a caller that knows what to do with each name.
  std::vector<Element> children();
  /// All children of that name.
  std::vector<Element> children(const char* name);
  /// Children that do nothing here, with everything in them.
  void child_without_effect(const char* name, std::string_view why);

  /// Reports attributes and children that were not read, repeated attributes, and text.
  /// @param elsewhere  where they belong, if all of them belong there
  /// @param names  of what belongs there, if not all
  void done(std::string_view elsewhere = {}, std::span<const std::string> names = {});
  /// The names of attributes and children that have been asked for.
  std::vector<std::string> asked() const;

  /// Reports this element as one that its parent can't hold.
  /// @param known  what the parent may hold;  @param home  where it can stand; empty: by its name
  void unknown_in(std::string_view parent, std::span<const std::string_view> known,
                  std::string_view home = {}) const;

  /// `attribute="value" of <element> <text>`.
  std::string sentence(const char* attribute, std::string_view text) const;
  /// Reports that sentence, at the value.
  /// @param causes  as of Report::fault
  void fault_at(const char* attribute, std::string_view text,
                std::vector<std::string_view> causes = {}) const;
  /// `<element> <text>`, at the element.
  /// @param causes  as of Report::fault
  void fault(std::string_view text, std::vector<std::string_view> causes = {}) const;

  /// Size of the element with its content, without white space and comments [bytes].
  std::size_t size() const;

 private:
  std::optional<std::string> take(const char* attribute);
  /// Names from the root's children to this one, `arena/box`; empty: the root.
  std::string path() const;

  Document* document_;
  pugi::xml_node node_;
  std::string_view name_;
  std::vector<std::string_view> asked_attributes_;
  std::vector<std::string_view> asked_children_;
  bool any_attribute_ = false;
  bool any_child_ = false;
  bool any_text_ = false;
};

std::string_view written(const Element& element, const char* attribute);

/// Reports that an element lacks an attribute. @param example  of its value
void missing(const Element& element, const char* attribute, std::string_view example);
/// Reports that it has none of some attributes of which one is needed.
void missing_all(const Element& element, std::span<const std::string_view> attributes);

/// The attribute's value; a missing or wrong one is a fault, and nothing.
template <class Read>
std::optional<Element::ValueOf<Read>> needed(Element& element, const char* attribute, Read read) {
  element.tell(attribute, read, Need::required);
  if (!element.has(attribute)) missing(element, attribute, example_of(read));
  return element.take(attribute, read);
}

template <class Read>
Element::ValueOf<Read> Element::required(const char* attribute, Read read, ValueOf<Read> fallback) {
  return needed(*this, attribute, read).value_or(std::move(fallback));
}

}  // namespace ziggurat::scene
