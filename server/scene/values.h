// SPDX-License-Identifier: MIT
#pragma once
// Readers of attributes' values: text in, SI units, radians and quaternions out. Every function
// takes the text with the white space around it removed.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "math/pose.h"
#include "scene/devices.h"
#include "scene/scene.h"
#include "text/shortened.h"

namespace ziggurat::scene {

/// Why a text is not a value: continues a sentence that begins with the attribute and its text,
/// for example `is not a number; write a finite decimal such as 0.25`.
struct Wrong {
  std::string text;
};

template <class T>
using Value = std::variant<T, Wrong>;

using text::trimmed;

/// The text as it may stand in a message: in quotes, shortened, control characters replaced.
std::string in_quotes(std::string_view text);

// --- numbers ------------------------------------------------------------------------------------

Value<double> number(std::string_view text);            ///< finite decimal, optional `f` behind it
Value<double> non_negative(std::string_view text);      ///< number >= 0
Value<double> positive(std::string_view text);          ///< number > 0
Value<double> length(std::string_view text);            ///< 1e-6 to 1e6 [m]
constexpr double heaviest_mass = 1e9;                   ///< of a body that moves [kg]
Value<double> mass(std::string_view text);              ///< 0, or 1e-9 and more [kg]
Value<double> probability(std::string_view text);       ///< 0 to 1
Value<double> half_angle(std::string_view text);        ///< 0 to 180 degrees -> [rad]
Value<double> angle(std::string_view text);             ///< degrees -> [rad]
Value<unsigned> count(std::string_view text);           ///< integer 0 to 4294967295
Value<unsigned> positive_count(std::string_view text);  ///< integer 1 to 4294967295
Value<double> duration(std::string_view text);          ///< 1e-6 or more [s]
Value<std::uint64_t> seed(std::string_view text);       ///< integer 0 to 2^64 - 1

// --- several numbers ----------------------------------------------------------------------------

Value<math::Vector2> vector2(std::string_view text);               ///< `x,y`
Value<math::Vector2> positive_vector2(std::string_view text);      ///< `x,y`, each > 0
Value<math::Vector3> vector3(std::string_view text);               ///< `x,y,z`
Value<math::Vector3> non_negative_vector3(std::string_view text);  ///< `x,y,z`, each >= 0
Value<math::Vector3> position(std::string_view text);              ///< `x,y,z`, each within 1e6 [m]
Value<math::Vector3> size(std::string_view text);                  ///< `x,y,z`, each a length [m]
Value<math::Vector3> room(std::string_view text);                  ///< the same; z may be 0
Value<math::Vector3> direction(std::string_view text);       ///< `x,y,z` not all 0 -> unit vector
Value<math::Quaternion> orientation(std::string_view text);  ///< `z,y,x` degrees -> Qx Qy Qz
Value<std::pair<double, double>> range(std::string_view text);           ///< `min:max`, min <= max
Value<std::pair<double, double>> positive_range(std::string_view text);  ///< `min:max`, 0 < min
Value<std::array<unsigned, 2>> resolution(std::string_view text);        ///< `width,height`, >= 1
Value<std::array<unsigned, 3>> cells(std::string_view text);             ///< `a,b,c`, each >= 1

Value<Response> response(std::string_view text);  ///< `distance:reading, …`, distances ascending

/// The rotation that `z,y,x` degrees stand for: about z first, then y, then x, all fixed axes.
math::Quaternion orientation_from_degrees(const math::Vector3& zyx);

// --- words --------------------------------------------------------------------------------------

Value<bool> boolean(std::string_view text);            ///< `true` or `false`
Value<std::string> text(std::string_view text);        ///< anything
Value<std::string> identifier(std::string_view text);  ///< 1 to 255 bytes, no control characters
Value<std::string> path(std::string_view text);        ///< not empty
Value<Color> color(std::string_view text);             ///< a name, or `r,g,b,a` of 0 to 255

/// Reads one of a fixed set of words.
template <class T>
class OneOf {
 public:
  OneOf(std::initializer_list<std::pair<std::string_view, T>> words) : words_(words) {}

  Value<T> operator()(std::string_view text) const {
    for (const auto& [word, meaning] : words_) {
      if (word == text) return meaning;
    }
    return Wrong{"is not one of the words known here; write one of: " + words(", ")};
  }

  /// The word with a meaning; empty: none.
  std::string_view word_of(const T& meaning) const {
    for (const auto& [word, known] : words_) {
      if (known == meaning) return word;
    }
    return {};
  }

  /// All of them.
  std::string words(std::string_view between = "|") const {
    std::string list;
    for (const auto& [word, meaning] : words_) {
      if (!list.empty()) list += between;
      list += word;
    }
    return list;
  }

 private:
  std::vector<std::pair<std::string_view, T>> words_;
};

/// Reads an integer from `least` to `most`.
struct Whole {
  unsigned least = 0, most = 0;
  Value<unsigned> operator()(std::string_view text) const;
};

/// Reads as another reader, and names the unit for the reference.
template <class T>
struct In {
  std::string_view unit;
  Value<T> (*read)(std::string_view);
  Value<T> operator()(std::string_view text) const { return read(text); }
};
template <class T>
In(std::string_view, Value<T> (*)(std::string_view)) -> In<T>;

/// Accepts exactly these words and keeps the text.
class Words {
 public:
  Words(std::initializer_list<std::string_view> words) : words_(words) {}
  explicit Words(std::vector<std::string_view> words) : words_(std::move(words)) {}
  Value<std::string> operator()(std::string_view text) const;
  /// All of them.
  std::string words(std::string_view between = "|") const;

 private:
  std::vector<std::string_view> words_;
};

/// The degrees that were probably meant by an angle that looks like one in radians, such as 1.57.
/// @param text  a number
std::optional<double> degrees_of_radians(std::string_view text);

}  // namespace ziggurat::scene
