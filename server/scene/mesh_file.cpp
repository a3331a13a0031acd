// SPDX-License-Identifier: MIT
#include "scene/mesh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <locale>
#include <optional>
#include <sstream>
#include <string_view>
#include <system_error>

#define TINYOBJLOADER_IMPLEMENTATION
#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>

namespace ziggurat::scene {
namespace {

using math::Vector3;
using Points = std::vector<Vector3>;
using Read = std::variant<Points, std::string>;

/// Whether three numbers stand at the beginning.
bool has_three_numbers(std::string_view text) {
  for (int i = 0; i < 3; ++i) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    if (text.starts_with('+')) text.remove_prefix(1);
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error == std::errc::invalid_argument) return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  }
  return true;
}

/// A line of a vertex that is cut off, or not written as one: its library would take 0 for what is
/// missing.
std::optional<std::string> fault_of_obj(std::string_view text) {
  for (std::size_t line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    std::string_view words = text.substr(0, end);
    words.remove_prefix(std::min(words.find_first_not_of(" \t"), words.size()));
    const bool is_vertex = words.starts_with("v ") || words.starts_with("v\t");
    if (is_vertex && !has_three_numbers(words.substr(2))) {
      return fmt::format(
          "is no whole .obj file: the vertex in line {} has no three numbers; write v X Y Z, or "
          "copy the "
          "file anew",
          line);
    }
    text.remove_prefix(std::min(end + (text.substr(end).starts_with("\r\n") ? 2 : 1), text.size()));
  }
  return std::nullopt;
}

Read read_obj(const std::string& text) {
  if (auto fault = fault_of_obj(text)) return *std::move(fault);
  tinyobj::ObjReaderConfig config;
  config.triangulate = false;
  config.vertex_color = false;
  tinyobj::ObjReader reader;
  if (!reader.ParseFromString(text, "", config)) {
    return fmt::format("is not an .obj file that can be read: {}", reader.Error());
  }
  const std::vector<double>& values = reader.GetAttrib().vertices;
  Points points;
  for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
    points.emplace_back(values[i], values[i + 1], values[i + 2]);
  }
  return points;
}

// A binary STL file: 80 bytes of anything, the number of triangles as 32 bits, then 50 bytes for
// each: its normal and its three corners as 12 floats, and 2 bytes of anything. Little-endian.
constexpr std::size_t stl_header = 84, stl_triangle = 50, stl_normal = 12;

template <class Number>
Number little_endian(const char* bytes) {
  std::uint32_t bits = 0;
  for (int i = 3; i >= 0; --i) bits = bits << 8 | static_cast<unsigned char>(bytes[i]);
  return std::bit_cast<Number>(bits);
}

bool is_binary_stl(const std::string& bytes) {
  if (bytes.size() < stl_header) return false;
  const std::size_t triangles = little_endian<std::uint32_t>(&bytes[80]);
  return bytes.size() == stl_header + triangles * stl_triangle;
}

Points read_binary_stl(const std::string& bytes) {
  Points points;
  for (std::size_t at = stl_header; at < bytes.size(); at += stl_triangle) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const char* xyz = &bytes[at + stl_normal + 12 * corner];
      points.emplace_back(little_endian<float>(xyz), little_endian<float>(xyz + 4),
                          little_endian<float>(xyz + 8));
    }
  }
  return points;
}

/// Why a file with bytes that no text has is no binary STL file.
std::string fault_of_binary_stl(const std::string& bytes) {
  constexpr const char* advice = "export it or copy it anew";
  if (bytes.size() < stl_header) {
    return fmt::format("is no whole STL file: it ends within its header, after {} of {} bytes; {}",
                       bytes.size(), stl_header, advice);
  }
  const std::uint64_t triangles = little_endian<std::uint32_t>(&bytes[80]);
  const std::uint64_t found = (bytes.size() - stl_header) / stl_triangle;
  if (found < triangles) {
    return fmt::format("is no whole STL file: it ends within triangle {} of {}; {}", found + 1,
                       triangles, advice);
  }
  return fmt::format(
      "is no STL file that can be read: its header tells of {} triangles, and {} bytes stand "
      "behind them; {}",
      triangles, bytes.size() - stl_header - triangles * stl_triangle, advice);
}

/// Each line `vertex x y z`.
Read read_text_stl(const std::string& text) {
  Points points;
  std::istringstream words(text);
  words.imbue(std::locale::classic());
  for (std::string word; words >> word;) {
    if (word != "vertex") continue;
    Vector3 point;
    if (!(words >> point.x() >> point.y() >> point.z())) {
      return fmt::format(
          "is no whole STL file: vertex {} has no three numbers; write vertex X Y Z, or copy the "
          "file anew",
          points.size() + 1);
    }
    points.push_back(point);
  }
  if (points.size() % 3 != 0) {
    return fmt::format(
        "is no whole STL file: it ends within triangle {}; export it or copy it anew",
        points.size() / 3 + 1);
  }
  return points;
}

Read read_stl(const std::string& bytes) {
  if (is_binary_stl(bytes)) return read_binary_stl(bytes);
  if (bytes.find('\0') != std::string::npos) return fault_of_binary_stl(bytes);
  return read_text_stl(bytes);
}

}  // namespace

std::variant<Points, std::string> read_mesh(const std::filesystem::path& name,
                                            const std::string& bytes) {
  std::string ending = name.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ending != ".obj" && ending != ".stl") return "is neither an .obj nor an .stl file";
  Read read = ending == ".obj" ? read_obj(bytes) : read_stl(bytes);
  const Points* points = std::get_if<Points>(&read);
  if (!points) return read;
  if (points->empty()) return "has no vertices; write a file with at least 4";
  constexpr double farthest = 1e6;  // [m], as for positions
  const bool near = std::ranges::all_of(*points, [&](const Vector3& point) {
    return (point.array().abs() <= farthest).all();  // false for what is not a number
  });
  if (!near) return "has a vertex that is not a number or farther than 1e6 from the origin";
  return read;
}

}  // namespace ziggurat::scene
