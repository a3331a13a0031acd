#pragma once
// The files that a run leaves behind, as the command line asks for them.

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "recording/hash_file.h"
#include "recording/images.h"
#include "recording/rays.h"
#include "recording/readings.h"
#include "recording/trace.h"
#include "reports/summary.h"
#include "run/options.h"
#include "run/pictures.h"
#include "simulation/simulation.h"

namespace ziggurat::run {

class Recorders {
 public:
  /// Creates all files, so that a path that can't be written is known before the run.
  /// @throws recording::WriteError
  /// @param scene, layout  have to outlive this
  /// @param seed  the one that the simulation was made with
  /// @throws render::RenderError if pictures are wanted and can't be had
  Recorders(const Options& options, const scene::Scene& scene, std::uint64_t seed,
            const world::Layout& layout);

  /// After a tick, and once for tick 0. @throws recording::WriteError
  void tick(const simulation::Simulation& simulation);

  /// What robots sensed and answered at a tick. @throws recording::WriteError
  void exchange(const world::State& state, const world::Observations& observations,
                const world::Commands& commands);

  /// Completes every file but the summary, also when one of them fails.
  /// @throws recording::WriteError
  void close();

  /// The paths of the pictures that were taken so far.
  std::span<const std::string> pictures() const;

  /// @throws recording::WriteError
  void write_summary(const reports::Summary& summary);

 private:
  std::optional<recording::Trace> trace_;
  std::optional<recording::HashFile> hashes_;
  std::optional<recording::Readings> readings_;
  std::optional<recording::Rays> rays_;
  std::optional<recording::OutputFile> summary_;
  std::optional<recording::Images> images_;
  std::optional<Pictures> pictures_;
};

}  // namespace ziggurat::run
