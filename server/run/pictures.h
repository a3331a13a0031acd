#pragma once
// The pictures that `ziggurat render` takes of a run.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "render/renderer.h"
#include "run/viewpoint.h"
#include "scene/scene.h"
#include "world/layout.h"
#include "world/state.h"

namespace ziggurat::run {

struct PictureOptions {
  std::vector<double> times{0};  ///< simulated [s], >= 0, in any order
  ViewOptions view;              ///< of all; chosen at the first
  std::string out;               ///< path; of several pictures, their pattern
};

/// The tick of the last picture.
std::uint64_t last_tick(const PictureOptions& options, const scene::Experiment& experiment);

/// The path of a picture. A single one is `out`. For several, `%d` or `%03d` in it is replaced by
/// the number; without that the number goes before the suffix.
std::string picture_path(const std::string& out, std::size_t number, std::size_t of);

class Pictures {
 public:
  /// @param entities  all of them, placed, in scene order
  /// @param scene, layout  must outlive this
  /// @throws render::RenderError
  Pictures(const PictureOptions& options, const scene::Scene& scene,
           std::vector<scene::Entity> entities, const world::Layout& layout);

  /// Takes the pictures of the state's tick. @throws recording::WriteError, render::RenderError
  void tick(const world::State& state);

  /// The paths of the pictures so far.
  const std::vector<std::string>& taken() const { return taken_; }

 private:
  PictureOptions options_;
  const scene::Scene& scene_;
  std::vector<scene::Entity> entities_;
  std::optional<render::View> view_;
  render::Renderer renderer_;
  render::Picture picture_;
  std::vector<std::string> taken_;
};

}  // namespace ziggurat::run
