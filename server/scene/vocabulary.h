// SPDX-License-Identifier: MIT
#pragma once
// The vocabulary of scenes: every attribute that the reader asks an element for, recorded while it
// reads. The reference is printed from it, so it can't differ from the reader.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/values.h"

namespace ziggurat::scene {

struct RunAttributes;

/// Type of a value as a reference names it.
struct Type {
  std::string_view name;       ///< `number > 0`
  std::string_view unit = {};  ///< as a scene has it, `m`; empty: none
  double in_unit = 1;          ///< factor from what the reader returns to the unit
};

enum class Need { required, optional, without_effect };

/// One attribute of one element.
struct Asked {
  std::string attribute, type, unit;
  std::vector<Need> needs;         ///< those of all variants of the element
  std::vector<std::string> usual;  ///< defaults, likewise, as a scene would have them
};

/// One element in one place.
struct Described {
  std::string name;
  std::string parent;  ///< path from the root, `arena/prototype`; empty: the root
  std::vector<Asked> attributes;
  std::vector<std::string> children;
};

/// In the order of a document: parents before their children.
struct Vocabulary {
  std::vector<Described> elements;
};

/// The element at a path, which is added with its parents if it is not there.
Described& element_at(Vocabulary& vocabulary, std::string_view path);
/// Adds an attribute, or what one more variant of its element says of it.
void add(Described& element, std::string_view attribute, Asked asked);

Type type_of(Value<double> (*read)(std::string_view));
Type type_of(Value<unsigned> (*read)(std::string_view));
Type type_of(Value<std::uint64_t> (*read)(std::string_view));
Type type_of(Value<bool> (*read)(std::string_view));
Type type_of(Value<std::string> (*read)(std::string_view));
Type type_of(Value<Color> (*read)(std::string_view));
Type type_of(Value<Response> (*read)(std::string_view));
Type type_of(Value<math::Vector2> (*read)(std::string_view));
Type type_of(Value<math::Vector3> (*read)(std::string_view));
Type type_of(Value<math::Quaternion> (*read)(std::string_view));
Type type_of(Value<std::pair<double, double>> (*read)(std::string_view));
Type type_of(Value<std::array<unsigned, 2>> (*read)(std::string_view));
Type type_of(Value<std::array<unsigned, 3>> (*read)(std::string_view));

std::string usual_text(double value, const Type& type);
std::string usual_text(unsigned value, const Type& type);
std::string usual_text(std::uint64_t value, const Type& type);
std::string usual_text(bool value, const Type& type);
std::string usual_text(const std::string& value, const Type& type);
std::string usual_text(const Color& value, const Type& type);
std::string usual_text(const math::Vector2& value, const Type& type);
std::string usual_text(const math::Vector3& value, const Type& type);
std::string usual_text(const math::Quaternion& value, const Type& type);
std::string usual_text(const std::pair<double, double>& value, const Type& type);

/// Type of what a reader returns that is no function.
template <class Read>
Type type_of(const Read& read) {
  if constexpr (requires { read.unit; }) {
    Type type = type_of(read.read);
    type.unit = read.unit;
    return type;
  } else if constexpr (requires { read.words(); }) {
    return {"word"};
  } else if constexpr (requires { read.least; }) {
    return {"whole"};
  } else {
    return {"as the option of `run`"};
  }
}

/// An attribute as the reference has it.
/// @param usual  its default; null: none
template <class Read, class T>
Asked asked_for(const Read& read, Need need, const T* usual) {
  const Type type = type_of(read);
  Asked asked{{}, std::string(type.name), std::string(type.unit), {need}, {}};
  if constexpr (requires { read.words(); }) asked.type = read.words();
  if constexpr (requires { read.least; }) {
    asked.type += " " + std::to_string(read.least) + " to " + std::to_string(read.most);
  }
  if (!usual) return asked;
  if constexpr (requires { read.word_of(*usual); }) {
    asked.usual.emplace_back(read.word_of(*usual));
  } else if constexpr (requires { usual_text(*usual, type); }) {
    asked.usual.push_back(usual_text(*usual, type));
  }
  return asked;
}

/// The vocabulary of everything that a scene may have.
/// @param run  attributes of <run>
Vocabulary whole_vocabulary(const RunAttributes& run);

}  // namespace ziggurat::scene
