// SPDX-License-Identifier: MIT
#pragma once
// The output files of a run.

#include <exception>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>

#include "outputs/hash_file.h"
#include "outputs/images.h"
#include "outputs/rays.h"
#include "outputs/readings.h"
#include "outputs/trace.h"
#include "reports/report_card.h"
#include "reports/summary.h"
#include "run/options.h"
#include "run/pictures.h"
#include "simulation/simulation.h"
#include "supervision/world.h"

namespace ziggurat::run {

/// Output files of a run. The output of a tick is on the disk within half a second of wall time.
/// This also holds while the world is paused or a tick takes long.
class Recorders {
 public:
  /// Creates all files, so that a path that cannot be written is reported before the run.
  /// @throws outputs::WriteError
  /// @param world  must outlive this
  Recorders(const Options& options, const supervision::World& world);

  /// Call it after each tick, and once for tick 0. @throws outputs::WriteError
  void tick(const simulation::Simulation& simulation);

  /// Writes the readings and commands of a tick. @throws outputs::WriteError
  void exchange(const world::State& state, const world::Observations& observations,
                const world::Commands& commands, const std::vector<world::Metric>& metrics);

  /// Writes all output that is not on the disk yet. An error is reported with the next tick. Any
  /// thread may call it.
  void flush();

  /// Completes every file except the summary and the report card, also if one of them fails.
  /// @throws outputs::WriteError
  void close();

  /// The paths of the pictures that were taken so far.
  std::span<const std::string> pictures() const;
  /// A sentence if a film has fewer frames than it should have, otherwise empty; after close().
  std::string missing_frames() const;

  /// @throws outputs::WriteError
  void write_summary(const reports::Summary& summary);

  /// As a picture if the file's name ends with .svg, tick by tick if with .csv, otherwise as JSON.
  /// @throws outputs::WriteError
  void write_report_card(const reports::ReportCard& card);

 private:
  void report_failed_flush();

  std::mutex mutex_;                 ///< of all files: a tick is written whole
  std::exception_ptr failed_flush_;  ///< what the other thread met; thrown by the next call
  std::optional<outputs::Trace> trace_;
  std::optional<outputs::HashFile> hashes_;
  std::optional<outputs::Readings> readings_;
  std::optional<outputs::Rays> rays_;
  std::optional<outputs::OutputFile> summary_;
  std::optional<outputs::OutputFile> report_card_;
  std::string (*report_card_text_)(const reports::ReportCard& card) = nullptr;
  std::optional<outputs::Images> images_;
  std::optional<Pictures> pictures_;
  std::jthread flushing_;  ///< the last: it uses the others
};

}  // namespace ziggurat::run
