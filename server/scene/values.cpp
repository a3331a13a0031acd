// SPDX-License-Identifier: MIT
#include "scene/values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <system_error>

#include "text/shortened.h"

namespace ziggurat::scene {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double shortest_length = 1e-6, longest_length = 1e6;
constexpr double shortest_duration = 1e-6;
constexpr double lightest_mass = 1e-9;

/// @param most  parts that are of interest: the last one returned may be cut off behind
std::vector<std::string_view> split(std::string_view text, char separator, std::size_t most = 9) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0;;) {
    const std::size_t end = text.find(separator, begin);
    parts.push_back(trimmed(text.substr(begin, end - begin)));
    if (end == std::string_view::npos || parts.size() == most) return parts;
    begin = end + 1;
  }
}

/// An unsigned integer; a decimal without fraction (`10.0`, `1e3`) counts as one.
Value<std::uint64_t> integer(std::string_view text, std::uint64_t least, std::uint64_t most) {
  std::uint64_t result = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), result);
  if (error != std::errc() || end != text.data() + text.size()) {
    const Value<double> decimal = number(text);
    if (std::holds_alternative<Wrong>(decimal)) {
      return Wrong{fmt::format("is not a whole number; write one from {} to {}", least, most)};
    }
    const double value = std::get<double>(decimal);
    if (value != std::floor(value)) {
      return Wrong{fmt::format("has a fraction; write a whole number from {} to {}", least, most)};
    }
    if (value < 0 || value > 9007199254740992.0) {
      return Wrong{fmt::format("is out of range; write a whole number from {} to {}", least, most)};
    }
    result = static_cast<std::uint64_t>(value);
  }
  if (result < least || result > most) {
    return Wrong{fmt::format("is out of range; write a whole number from {} to {}", least, most)};
  }
  return result;
}

Value<unsigned> small_integer(std::string_view text, unsigned least,
                              unsigned most = std::numeric_limits<unsigned>::max()) {
  const auto value = integer(text, least, most);
  if (const Wrong* wrong = std::get_if<Wrong>(&value)) return *wrong;
  return static_cast<unsigned>(std::get<std::uint64_t>(value));
}

/// Reads `names` (for example "x,y,z") with one reader per component.
template <class T, std::size_t N, class Read>
Value<std::array<T, N>> components(std::string_view text, std::string_view names, Read read) {
  const std::vector<std::string_view> parts = split(text, ',');
  if (parts.size() != N) {
    return Wrong{fmt::format(
        "has {}{} component{} instead of {}; write {}", parts.size() > 8 ? "more than " : "",
        std::min<std::size_t>(parts.size(), 8), parts.size() == 1 ? "" : "s", N, names)};
  }
  std::array<T, N> result{};
  for (std::size_t i = 0; i < N; ++i) {
    Value<T> value = read(parts[i]);
    if (const Wrong* wrong = std::get_if<Wrong>(&value)) {
      return Wrong{fmt::format("is not {}: component {}, {}, {}", names, i + 1, in_quotes(parts[i]),
                               wrong->text)};
    }
    result[i] = std::get<T>(value);
  }
  return result;
}

template <class Read>
Value<math::Vector3> three(std::string_view text, std::string_view names, Read read) {
  const auto parts = components<double, 3>(text, names, read);
  if (const Wrong* wrong = std::get_if<Wrong>(&parts)) return *wrong;
  const auto& [x, y, z] = std::get<0>(parts);
  return math::Vector3(x, y, z);
}

template <class Read>
Value<math::Vector2> two(std::string_view text, Read read) {
  const auto parts = components<double, 2>(text, "x,y", read);
  if (const Wrong* wrong = std::get_if<Wrong>(&parts)) return *wrong;
  const auto& [x, y] = std::get<0>(parts);
  return math::Vector2(x, y);
}

Value<double> coordinate(std::string_view text) {
  Value<double> value = number(text);
  if (const double* metres = std::get_if<double>(&value)) {
    if (std::abs(*metres) > longest_length) return Wrong{"is too far away; stay within 1e6 m"};
  }
  return value;
}

constexpr std::array<std::pair<std::string_view, Color>, 20> named_colors{{
    {"black", {0, 0, 0}},        {"white", {255, 255, 255}},  {"red", {255, 0, 0}},
    {"green", {0, 255, 0}},      {"blue", {0, 0, 255}},       {"magenta", {255, 0, 255}},
    {"cyan", {0, 255, 255}},     {"yellow", {255, 255, 0}},   {"orange", {255, 140, 0}},
    {"brown", {165, 42, 42}},    {"purple", {160, 32, 240}},  {"gray10", {26, 26, 26}},
    {"gray20", {51, 51, 51}},    {"gray30", {77, 77, 77}},    {"gray40", {102, 102, 102}},
    {"gray50", {127, 127, 127}}, {"gray60", {153, 153, 153}}, {"gray70", {179, 179, 179}},
    {"gray80", {204, 204, 204}}, {"gray90", {229, 229, 229}},
}};

}  // namespace

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 60;
  std::string result = text::shortened(text, longest);
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  std::ranges::replace_if(result, is_control, ' ');
  return '"' + result + '"';
}

Value<double> number(std::string_view text) {
  const Wrong wrong{"is not a number; write a finite decimal such as 0.25"};
  std::string_view digits = text;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  const std::size_t sign = digits.starts_with('-') && digits.size() == text.size() ? 1 : 0;
  if (digits.size() <= sign) return wrong;
  const char first = digits[sign];
  if (first != '.' && (first < '0' || first > '9')) return wrong;  // inf, nan
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range) {
    return Wrong{"is out of range; write a finite decimal such as 0.25"};
  }
  const std::string_view rest = digits.substr(static_cast<std::size_t>(end - digits.data()));
  if (error != std::errc()) return wrong;
  if (!rest.empty() && rest != "f") {
    return Wrong{fmt::format("has {} behind the number; write a finite decimal such as 0.25",
                             in_quotes(rest))};
  }
  return value;
}

Value<double> non_negative(std::string_view text) {
  Value<double> value = number(text);
  if (const double* v = std::get_if<double>(&value); v && *v < 0) {
    return Wrong{"is negative; write 0 or more"};
  }
  return value;
}

Value<double> positive(std::string_view text) {
  Value<double> value = number(text);
  if (const double* v = std::get_if<double>(&value); v && !(*v > 0)) {
    return Wrong{"is not positive; write more than 0"};
  }
  return value;
}

Value<double> length(std::string_view text) {
  Value<double> value = number(text);
  const double* v = std::get_if<double>(&value);
  if (!v || (*v >= shortest_length && *v <= longest_length)) return value;
  if (*v < 0) return Wrong{"is not positive; write a length from 1e-6 to 1e6 m"};
  if (*v < shortest_length) {
    return Wrong{
        "is below 1e-6 m, the least length of a scene: what has no extent has no inertia and "
        "touches "
        "nothing; write 1e-6 to 1e6 m"};
  }
  return Wrong{
      "is above 1e6 m, the largest length of a scene: beyond, contacts are inexact; write 1e-6 to "
      "1e6 m"};
}

Value<double> mass(std::string_view text) {
  Value<double> value = number(text);
  if (const double* v = std::get_if<double>(&value); v && *v < 0) {
    return Wrong{"is negative; write more than 0 kg"};
  }
  if (const double* v = std::get_if<double>(&value); v && *v != 0 && *v < lightest_mass) {
    return Wrong{
        "is below 1e-9 kg, the least mass of a body: contacts of bodies whose masses are further "
        "apart are inexact; write 1e-9 to 1e9 kg"};
  }
  return value;
}

Value<double> probability(std::string_view text) {
  Value<double> value = number(text);
  if (const double* v = std::get_if<double>(&value); v && (*v < 0 || *v > 1)) {
    return Wrong{"is not within 0 to 1; write a number from 0 to 1"};
  }
  return value;
}

Value<double> angle(std::string_view text) {
  Value<double> value = number(text);
  if (const double* degrees = std::get_if<double>(&value)) return *degrees * degree;
  return value;
}

Value<double> half_angle(std::string_view text) {
  Value<double> value = number(text);
  if (const double* degrees = std::get_if<double>(&value)) {
    if (*degrees < 0 || *degrees > 180) {
      return Wrong{"is not a half-angle; write 0 to 180 degrees"};
    }
    return *degrees * degree;
  }
  return value;
}

Value<double> duration(std::string_view text) {
  Value<double> value = positive(text);
  if (const double* v = std::get_if<double>(&value); v && *v < shortest_duration) {
    return Wrong{"is too short; write 1e-6 s or more"};
  }
  return value;
}

Value<unsigned> count(std::string_view text) { return small_integer(text, 0); }

Value<unsigned> positive_count(std::string_view text) { return small_integer(text, 1); }

Value<std::uint64_t> seed(std::string_view text) {
  return integer(text, 0, std::numeric_limits<std::uint64_t>::max());
}

Value<math::Vector2> vector2(std::string_view text) { return two(text, number); }

Value<math::Vector2> positive_vector2(std::string_view text) { return two(text, positive); }

Value<math::Vector3> vector3(std::string_view text) { return three(text, "x,y,z", number); }

Value<math::Vector3> non_negative_vector3(std::string_view text) {
  return three(text, "x,y,z", non_negative);
}

Value<math::Vector3> position(std::string_view text) { return three(text, "x,y,z", coordinate); }

Value<math::Vector3> size(std::string_view text) { return three(text, "x,y,z", length); }

Value<math::Vector3> room(std::string_view text) {
  const std::size_t last = text.rfind(',');
  const std::string_view height = last == text.npos ? text : trimmed(text.substr(last + 1));
  const Value<double> z = number(height);
  const double* is = std::get_if<double>(&z);
  if (!is || *is != 0) return size(text);
  const std::string with_height = std::string(text.substr(0, last == text.npos ? 0 : last)) + ",1";
  Value<math::Vector3> flat = size(std::string_view(with_height));
  if (math::Vector3* v = std::get_if<math::Vector3>(&flat)) v->z() = 0;
  return flat;
}

Value<math::Vector3> direction(std::string_view text) {
  Value<math::Vector3> value = vector3(text);
  if (const math::Vector3* v = std::get_if<math::Vector3>(&value)) {
    const double largest = v->cwiseAbs().maxCoeff();
    if (largest == 0) return Wrong{"has no direction; write x,y,z that are not all 0"};
    return math::Vector3((*v / largest).normalized());
  }
  return value;
}

math::Quaternion orientation_from_degrees(const math::Vector3& zyx) {
  using Turn = Eigen::AngleAxisd;
  const math::Vector3 radians = zyx * degree;
  const math::Quaternion q = Turn(radians.z(), math::Vector3::UnitX()) *
                             Turn(radians.y(), math::Vector3::UnitY()) *
                             Turn(radians.x(), math::Vector3::UnitZ());
  return q.normalized();
}

Value<math::Quaternion> orientation(std::string_view text) {
  const Value<math::Vector3> value = three(text, "z,y,x in degrees", number);
  if (const Wrong* wrong = std::get_if<Wrong>(&value)) return *wrong;
  return orientation_from_degrees(std::get<math::Vector3>(value));
}

Value<std::pair<double, double>> range(std::string_view text) {
  const std::vector<std::string_view> parts = split(text, ':');
  if (parts.size() != 2) {
    return Wrong{fmt::format("is not a range; write min:max with one colon, such as 0.1:0.5")};
  }
  std::array<double, 2> ends{};
  for (std::size_t i = 0; i < 2; ++i) {
    const Value<double> value = number(parts[i]);
    if (const Wrong* wrong = std::get_if<Wrong>(&value)) {
      return Wrong{fmt::format("is not a range: its {}, {}, {}", i == 0 ? "min" : "max",
                               in_quotes(parts[i]), wrong->text)};
    }
    ends[i] = std::get<double>(value);
  }
  if (ends[0] > ends[1]) return Wrong{"has its min above its max; write min:max, smaller first"};
  return std::pair(ends[0], ends[1]);
}

Value<Response> response(std::string_view text) {
  constexpr std::size_t most_points = 1000;
  constexpr const char* form = "write distance:reading, … with ascending distances";
  Response result;
  for (const std::string_view part : split(text, ',', most_points + 1)) {
    if (result.points.size() == most_points) {
      return Wrong{fmt::format("has more than {} points; write fewer", most_points)};
    }
    const std::vector<std::string_view> pair = split(part, ':');
    if (pair.size() != 2) return Wrong{std::string("is not a table; ") + form};
    const auto distance = non_negative(trimmed(pair[0]));
    const auto reading = number(trimmed(pair[1]));
    if (const Wrong* wrong = std::get_if<Wrong>(&distance)) return *wrong;
    if (const Wrong* wrong = std::get_if<Wrong>(&reading)) return *wrong;
    const Response::Point point{std::get<double>(distance), std::get<double>(reading)};
    if (!result.points.empty() && point.distance <= result.points.back().distance) {
      return Wrong{std::string("has distances that do not ascend; ") + form};
    }
    result.points.push_back(point);
  }
  return result;
}

Value<std::pair<double, double>> positive_range(std::string_view text) {
  Value<std::pair<double, double>> value = range(text);
  if (const auto* ends = std::get_if<std::pair<double, double>>(&value)) {
    if (!(ends->first > 0)) return Wrong{"does not begin above 0; write min:max with min > 0"};
  }
  return value;
}

Value<std::array<unsigned, 2>> resolution(std::string_view text) {
  return components<unsigned, 2>(text, "width,height", positive_count);
}

Value<std::array<unsigned, 3>> cells(std::string_view text) {
  return components<unsigned, 3>(text, "a,b,c", positive_count);
}

Value<bool> boolean(std::string_view text) {
  if (text == "true") return true;
  if (text == "false") return false;
  return Wrong{"is not a truth value; write true or false"};
}

Value<std::string> text(std::string_view text) { return std::string(text); }

Value<std::string> identifier(std::string_view text) {
  constexpr std::size_t longest = 255;
  if (text.empty()) return Wrong{"is empty; write a name"};
  if (text.size() > longest) return Wrong{"is too long; write a name of at most 255 bytes"};
  if (std::any_of(text.begin(), text.end(),
                  [](unsigned char c) { return c < 0x20 || c == 0x7f; })) {
    return Wrong{"contains a control character; write a name without"};
  }
  return std::string(text);
}

Value<std::string> path(std::string_view text) {
  if (text.empty()) return Wrong{"is empty; write the path of a file"};
  return std::string(text);
}

Value<Color> color(std::string_view text) {
  for (const auto& [name, value] : named_colors) {
    if (name == text) return value;
  }
  if (text.find(',') == std::string_view::npos) {
    return Wrong{
        "is not a colour; write r,g,b,a of 0 to 255 or one of black, white, red, green, blue, "
        "magenta, cyan, yellow, orange, brown, purple, gray10 … gray90"};
  }
  const auto channels =
      components<unsigned, 4>(text, "r,g,b,a", [](std::string_view part) -> Value<unsigned> {
        const auto value = integer(part, 0, 255);
        if (const Wrong* wrong = std::get_if<Wrong>(&value)) return *wrong;
        return static_cast<unsigned>(std::get<std::uint64_t>(value));
      });
  if (const Wrong* wrong = std::get_if<Wrong>(&channels)) return *wrong;
  const auto& rgba = std::get<0>(channels);
  return Color{static_cast<std::uint8_t>(rgba[0]), static_cast<std::uint8_t>(rgba[1]),
               static_cast<std::uint8_t>(rgba[2])};
}

Value<unsigned> Whole::operator()(std::string_view text) const {
  return small_integer(text, least, most);
}

Value<std::string> Words::operator()(std::string_view text) const {
  if (std::ranges::find(words_, text) != words_.end()) return std::string(text);
  return Wrong{"is not one of the words known here; write one of: " + words(", ")};
}

std::string Words::words(std::string_view between) const {
  return fmt::format("{}", fmt::join(words_, between));
}

std::optional<double> degrees_of_radians(std::string_view text) {
  const std::size_t point = text.find('.');
  if (point == std::string_view::npos) return std::nullopt;
  const auto digits = static_cast<int>(
      std::ranges::count_if(text.substr(point), [](char c) { return c >= '0' && c <= '9'; }));
  const Value<double> value = number(text);
  if (digits < 2 || std::holds_alternative<Wrong>(value)) return std::nullopt;
  const double size = std::abs(std::get<double>(value)), unit = std::pow(10.0, -digits);
  // Multiples of 15 degrees; with two digits only those of 45, as 0.52 may be meant.
  for (int angle = digits < 3 ? 45 : 15; angle <= 360; angle += digits < 3 ? 45 : 15) {
    const double radians = angle * degree;
    const bool is_rounded = std::abs(size - radians) <= 0.51 * unit;
    const bool is_cut = size <= radians && radians - size < unit;
    if (is_rounded || is_cut) return std::get<double>(value) < 0 ? -angle : angle;
  }
  return std::nullopt;
}

}  // namespace ziggurat::scene
