// SPDX-License-Identifier: MIT
#pragma once
// Old words of the dialect: attributes, elements and values that other versions of it have, and
// what they are here. None of them is a fault; each is a notice.

#include <string>
#include <string_view>

namespace ziggurat::scene {

struct OldWord {
  enum class Kind { attribute, element, value };

  Kind kind = Kind::attribute;
  std::string_view home;   ///< the element that it stands in; empty: any
  std::string_view word;   ///< name of the attribute or element
  std::string_view value;  ///< of that attribute; of Kind::value only
  std::string_view now;    ///< what it is read as; empty: it has no effect
  std::string_view why;    ///< of that; continues the notice
};

/// Meaning of an attribute of that name in an element; null: it is unknown.
const OldWord* old_attribute(std::string_view home, std::string_view name);
/// The attribute of other versions that is read as this one; null: none.
const OldWord* old_name_of(std::string_view home, std::string_view attribute);
/// Meaning of an element of that name in another; null: it is unknown.
const OldWord* old_element(std::string_view home, std::string_view name);
/// Value that stands for this value of an attribute; null: it stands for itself.
const OldWord* old_value(std::string_view home, std::string_view attribute, std::string_view value);

/// The notice: `index="dummy" of <led> is read as "grid": …`.
std::string notice_of(const OldWord& word, std::string_view home);

}  // namespace ziggurat::scene
