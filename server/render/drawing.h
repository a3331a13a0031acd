// SPDX-License-Identifier: MIT
#pragma once
// One view of a state as the arrays that are drawn, in the camera's frame. No pixels here.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "render/labels.h"
#include "render/meshes.h"
#include "render/model.h"
#include "render/view.h"
#include "world/layout.h"
#include "world/state.h"

namespace ziggurat::render {

using Float3 = std::array<float, 3>;
inline Float3 to_floats(const math::Vector3& vector) {
  return {static_cast<float>(vector.x()), static_cast<float>(vector.y()),
          static_cast<float>(vector.z())};
}
inline Float3 to_floats(const Rgb& color) { return {color.x(), color.y(), color.z()}; }
using Matrix4 = std::array<float, 16>;  ///< column by column

/// A link. Camera frame: +z forward, +x right, +y down [m].
struct BodyInstance {
  std::array<Float3, 3> axes;  ///< of the link's frame, as long as the mesh's axes stand for [m]
  Float3 position;
  Float3 size;   ///< full extents along the link's axes [m]
  Float3 color;  ///< linear light
};

/// A tag or LED: a flat square, or the disc in it.
struct MarkInstance {
  enum Kind : std::uint32_t { pattern, plain, disc };
  Float3 center;
  Float3 x, y;   ///< half sides, along the axes of its frame [m]; seen from x cross y
  Float3 color;  ///< sRGB; of discs
  std::array<std::uint32_t, 3> code;  ///< kind; a pattern's bits 0 to 31, and 32 to 35
};

/// A segment, as wide as the canvas draws lines; both ends are in front of the camera.
struct LineInstance {
  Float3 start, end;  ///< [m]
  Float3 color;       ///< sRGB
};

/// Links that are drawn as one mesh: first those in view, then those that only throw shadows.
struct Batch {
  Mesh mesh;
  std::size_t first = 0;             ///< into Drawing::bodies
  std::size_t visible = 0, all = 0;  ///< counts
};

struct Drawing {
  std::vector<BodyInstance> bodies;
  std::vector<Batch> batches;
  std::vector<MarkInstance> marks;
  std::vector<LineInstance> lines;
  std::vector<Label> labels;
  std::vector<world::FloorPaint> floor;  ///< what was painted on it
  Float3 sun;                            ///< unit, towards the sun
  Float3 right, ahead, up;               ///< world's x, y and z
  Matrix4
      light_from_camera;    ///< to 0 ... 1 in x and y on the shadow map, and in z away from the sun
  double shadow_texel = 0;  ///< side of a texel of the shadow map [m]; 0: no shadows
};

/// The side of the shadow map [texels].
constexpr unsigned shadow_size = 2048;

/// Fills drawings; their memory is used again.
class Draftsman {
 public:
  Draftsman(Model model, const world::Layout& layout);

  const Meshes& meshes() const { return meshes_; }
  const Model& model() const { return model_; }
  /// A new entity; its links are the next of the layout.
  /// @param first_link  its place in the layout; what was added from there on is forgotten
  void add(const scene::Entity& entity, std::size_t first_link);
  void draw(const world::State& state, const View& view, Drawing& drawing);

 private:
  struct Bucket {
    std::vector<BodyInstance> visible, hidden;
  };
  struct Stroke;
  void add_hulls(std::size_t first_body);
  void add_bodies(const world::State& state, const View& view, Drawing& drawing);
  void add_marks(const world::State& state, const View& view, Drawing& drawing) const;
  void add_rays(const world::State& state, const View& view, Drawing& drawing) const;
  void add_frusta(const world::State& state, const View& view, Drawing& drawing) const;
  void add_labels(const world::State& state, const View& view, Drawing& drawing) const;

  Model model_;
  const world::Layout& layout_;
  Meshes meshes_;
  std::vector<Mesh> mesh_of_bucket_;
  std::vector<Bucket> buckets_;  // parallel to mesh_of_bucket_
  std::unordered_map<std::shared_ptr<const scene::Polyhedron>, std::size_t> bucket_of_hull_;
};

}  // namespace ziggurat::render
