// SPDX-License-Identifier: MIT
#pragma once
// Points from the files of triangles that drawing programs write.

#include <cstddef>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "math/pose.h"

namespace ziggurat::scene {

inline constexpr std::size_t most_mesh_bytes = std::size_t{16} << 20;

/// The vertices in a Wavefront .obj file or an STL file, binary or as text; finite, repeated as
/// the file repeats them. Or why there are none: `is …; write …`.
/// @param name  whose ending says which of the two it is
std::variant<std::vector<math::Vector3>, std::string> read_mesh(const std::filesystem::path& name,
                                                                const std::string& bytes);

}  // namespace ziggurat::scene
