#include "scene/mesh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstdint>
#include <locale>
#include <sstream>
#include <string_view>

#define TINYOBJLOADER_IMPLEMENTATION
#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>

namespace ziggurat::scene {
namespace {

using math::Vector3;
using Points = std::vector<Vector3>;
using Read = std::variant<Points, std::string>;

Read read_obj(const std::string& text) {
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

/// Each line `vertex x y z`.
Read read_text_stl(const std::string& text) {
  Points points;
  std::istringstream words(text);
  words.imbue(std::locale::classic());
  for (std::string word; words >> word;) {
    if (word != "vertex") continue;
    Vector3 point;
    if (!(words >> point.x() >> point.y() >> point.z())) {
      return fmt::format("is not an STL file that can be read: vertex {} has no three numbers",
                         points.size() + 1);
    }
    points.push_back(point);
  }
  return points;
}

Read read_stl(const std::string& bytes) {
  if (is_binary_stl(bytes)) return read_binary_stl(bytes);
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
