// SPDX-License-Identifier: MIT
#pragma once
// The pictures and the film that `ziggurat render` takes of a run.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "outputs/film.h"
#include "render/several.h"
#include "run/viewpoint.h"
#include "scene/scene.h"
#include "simulation/simulation.h"
#include "world/state.h"

namespace ziggurat::run {

struct FilmOptions {
  std::string path;
  double frames_per_second = 30;  ///< as it is played, > 0
  double speed = 1;               ///< simulated seconds per second as it is played, > 0
  double from = 0;                ///< simulated [s], >= 0
  std::optional<double> to;       ///< simulated [s], > from; nothing: the end of the scene
};

struct PictureOptions {
  std::vector<double> times{0};  ///< simulated [s], >= 0, in any order
  ViewOptions view;              ///< of all; chosen at the first
  std::string out;               ///< path; of several pictures, their pattern; empty: none is taken
  std::optional<FilmOptions> film;
};

/// The tick of the last picture. @throws text::UsageError if the film has no end
std::uint64_t last_tick(const PictureOptions& options, const scene::Experiment& experiment);

/// Checks that a path has at most one number of a picture, and nothing else that printf() would
/// replace.
/// @throws text::UsageError
void check_picture_path(const std::string& out);

/// The path of a picture. A single one is `out`. For several, `%d` or `%03d` in it is replaced by
/// the number; without that the number goes before the suffix.
std::string picture_path(const std::string& out, std::size_t number, std::size_t of);

/// Draws on other threads while the run goes on.
class Pictures {
 public:
  /// @param scene  must outlive this
  /// @throws outputs::WriteError; text::UsageError if there is no entity to
  /// follow
  Pictures(const PictureOptions& options, const scene::Scene& scene,
           const simulation::Simulation& simulation);

  /// Takes the pictures of the world's tick, with its rays if the view asks for them; waits for
  /// earlier ones if they are many.
  /// @throws outputs::WriteError
  void tick(const simulation::Simulation& simulation);

  /// Waits for all pictures, and completes the film with the frames that it has.
  /// @throws as tick()
  void close();

  /// The paths of pictures and film, after close().
  const std::vector<std::string>& taken() const { return taken_; }
  /// A sentence if there are fewer pictures, or frames of the film, than there should be, otherwise
  /// empty; after close().
  std::string shortcoming() const;

 private:
  render::View view(const world::State& state);
  void populate(const simulation::Simulation& simulation);
  void draw(const simulation::Simulation& simulation, const render::View& view,
            render::Several::Take take);

  PictureOptions options_;
  const scene::Scene& scene_;
  std::vector<scene::Entity> entities_;
  std::vector<world::EntityLayout> places_;  // of these; none: they may be others now
  std::uint64_t next_tick_ = 0;
  std::optional<std::size_t> followed_;  // into the layout
  std::size_t followed_link_ = 0;        // its first
  std::optional<render::View> view_;
  math::Vector3 seen_at_ = math::Vector3::Zero();  // where the followed entity was then
  std::uint64_t next_frame_ = 0, frames_ = 0;
  std::vector<std::string> taken_;
  std::size_t pictures_ = 0;  // of these
  std::optional<outputs::Film> film_;
  std::optional<render::Several> several_;  // the last: its threads use the film
};

}  // namespace ziggurat::run
