// SPDX-License-Identifier: MIT
#include "scene/vocabulary.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

namespace ziggurat::scene {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

template <class T>
struct Row {
  Value<T> (*read)(std::string_view);
  Type type;
};

/// The row of a reader, or what most readers of such values have.
template <class T, std::size_t count>
Type find(const Row<T> (&rows)[count], Value<T> (*read)(std::string_view), Type otherwise = {}) {
  const auto row = std::ranges::find(rows, read, &Row<T>::read);
  return row == std::end(rows) ? otherwise : row->type;
}

constexpr std::string_view meters = "m";

template <class T>
void add_new(std::vector<T>& all, const std::vector<T>& more) {
  for (const T& each : more) {
    if (std::ranges::find(all, each) == all.end()) all.push_back(each);
  }
}

}  // namespace

Type type_of(Value<double> (*read)(std::string_view)) {
  constexpr Row<double> rows[] = {{number, {"number"}},
                                  {non_negative, {"number ≥ 0"}},
                                  {positive, {"number > 0"}},
                                  {length, {"length", meters}},
                                  {mass, {"mass", "kg"}},
                                  {probability, {"number 0 to 1"}},
                                  {half_angle, {"angle 0 to 180", "°", degrees}},
                                  {angle, {"angle", "°", degrees}},
                                  {duration, {"number ≥ 1e-6", "s"}}};
  return find(rows, read);
}

Type type_of(Value<unsigned> (*read)(std::string_view)) {
  constexpr Row<unsigned> rows[] = {{count, {"whole"}}, {positive_count, {"whole ≥ 1"}}};
  return find(rows, read);
}

Type type_of(Value<std::uint64_t> (*)(std::string_view)) { return {"whole"}; }
Type type_of(Value<bool> (*)(std::string_view)) { return {"truth"}; }
Type type_of(Value<Color> (*)(std::string_view)) { return {"colour"}; }
Type type_of(Value<Response> (*)(std::string_view)) { return {"distance:reading, …"}; }
Type type_of(Value<math::Quaternion> (*)(std::string_view)) { return {"orientation", "°"}; }

Type type_of(Value<std::string> (*read)(std::string_view)) {
  constexpr Row<std::string> rows[] = {{text, {"text"}}, {path, {"path"}}};
  return find(rows, read, {"name"});
}

Type type_of(Value<math::Vector2> (*read)(std::string_view)) {
  constexpr Row<math::Vector2> rows[] = {{positive_vector2, {"x,y, each > 0"}}};
  return find(rows, read, {"x,y"});
}

Type type_of(Value<math::Vector3> (*read)(std::string_view)) {
  constexpr Row<math::Vector3> rows[] = {{non_negative_vector3, {"vector, each ≥ 0"}},
                                         {position, {"position", meters}},
                                         {size, {"vector of lengths", meters}},
                                         {room, {"vector of lengths", meters}},
                                         {direction, {"direction"}}};
  return find(rows, read, {"vector"});
}

Type type_of(Value<std::pair<double, double>> (*read)(std::string_view)) {
  constexpr Row<std::pair<double, double>> rows[] = {{positive_range, {"range, min > 0"}}};
  return find(rows, read, {"range"});
}

Type type_of(Value<std::array<unsigned, 2>> (*)(std::string_view)) { return {"width,height"}; }
Type type_of(Value<std::array<unsigned, 3>> (*)(std::string_view)) { return {"a,b,c, each ≥ 1"}; }

std::string usual_text(double value, const Type& type) {
  return fmt::format("{:.6g}", value * type.in_unit);
}
std::string usual_text(unsigned value, const Type&) { return std::to_string(value); }
std::string usual_text(std::uint64_t value, const Type&) { return std::to_string(value); }
std::string usual_text(bool value, const Type&) { return value ? "true" : "false"; }
std::string usual_text(const std::string& value, const Type&) { return value; }

std::string usual_text(const Color& value, const Type&) {
  if (value == Color{}) return "black";
  return fmt::format("{},{},{},255", value.red, value.green, value.blue);
}

std::string usual_text(const math::Vector2& value, const Type&) {
  return fmt::format("{:.6g},{:.6g}", value.x(), value.y());
}

std::string usual_text(const math::Vector3& value, const Type&) {
  return fmt::format("{:.6g},{:.6g},{:.6g}", value.x(), value.y(), value.z());
}

std::string usual_text(const math::Quaternion& value, const Type&) {
  return value.isApprox(math::Quaternion::Identity()) ? "0,0,0" : "";
}

std::string usual_text(const std::pair<double, double>& value, const Type& type) {
  return usual_text(value.first, type) + ":" + usual_text(value.second, type);
}

Described& element_at(Vocabulary& vocabulary, std::string_view path) {
  const std::size_t slash = path.rfind('/');
  const std::string_view parent = slash == path.npos ? std::string_view() : path.substr(0, slash);
  const std::string_view name = slash == path.npos ? path : path.substr(slash + 1);
  const auto is_it = [&](const Described& one) { return one.name == name && one.parent == parent; };
  const auto found = std::ranges::find_if(vocabulary.elements, is_it);
  if (found != vocabulary.elements.end()) return *found;
  if (!parent.empty()) {
    std::vector<std::string>& siblings = element_at(vocabulary, parent).children;
    siblings.emplace_back(name);
  }
  return vocabulary.elements.emplace_back(
      Described{std::string(name), std::string(parent), {}, {}});
}

void add(Described& element, std::string_view attribute, Asked asked) {
  asked.attribute = attribute;
  const auto known = std::ranges::find(element.attributes, attribute, &Asked::attribute);
  if (known == element.attributes.end()) return element.attributes.push_back(std::move(asked));
  if (known->needs == std::vector{Need::without_effect}) {  // of another variant
    known->type = asked.type;
    known->unit = asked.unit;
  }
  add_new(known->needs, asked.needs);
  add_new(known->usual, asked.usual);
}

}  // namespace ziggurat::scene
