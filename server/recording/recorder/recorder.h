// SPDX-License-Identifier: MIT
#pragma once
// A run on its way into a recording, on a thread of its own. The run's thread only copies. If the
// disk or the thread is slower than the run, the run waits: a recording is whole, and what a killed
// run loses is bounded. A disk that takes nothing any more ends the recording.

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "recording/recorder/recording.h"

namespace ziggurat::recorder {

struct Settings {
  std::string path;
  mcap::Compression compression = mcap::Compression::zstd;
  Contents contents;
  std::chrono::milliseconds patience{30'000};  ///< how long the disk may take nothing
};

class Recorder {
 public:
  /// Creates the file. @throws outputs::WriteError
  Recorder(Settings settings, Start start);
  /// Without close() the recording has no end.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  bool wants(std::string_view topic) const { return !wants_ || wants_(topic); }

  // The methods of Recording, which says what they mean. What they are given is copied.
  void populate(const channels::Population& population);
  void tick(const channels::Moment& moment);
  void moved(const std::string& entity, const math::Pose& pose);
  /// @param position  [m] or [rad]
  /// @param velocity  [m/s] or [rad/s]
  void joint_set(const std::string& entity, const std::string& joint, double position,
                 double velocity);
  /// @param files  that were read for it
  void spawned(const std::string& xml, std::vector<EmbeddedFile> files);
  void removed(const std::string& entity);
  void reset(std::uint64_t seed);
  void kept(const std::string& snapshot);
  /// @param bytes  of its file, which is embedded once; empty: it was kept in this run
  void restored(const std::string& snapshot, std::span<const std::byte> bytes);
  void set_paused(bool is_paused);
  void log(channels::Severity severity, std::string_view name, std::string_view text);
  void step(const world::Commands& commands, std::vector<world::Metric> metrics = {});

  /// Completes the file, and waits for that, as long as the disk takes something.
  /// @param metrics  that were set since the last tick
  void close(std::vector<world::Metric> metrics = {});
  /// Why the recording has ended too early; once.
  std::optional<std::string> take_failure();

 private:
  using clock = std::chrono::steady_clock;
  struct Task {
    enum class Kind { tick, step, other };
    std::function<void(Recording&)> run;
    std::size_t size = 0;  // memory that it holds, about [bytes]
    Kind kind = Kind::other;
    clock::time_point begin = clock::now();
  };
  struct Shared;

  void add(std::function<void(Recording&)> run, std::size_t size,
           Task::Kind kind = Task::Kind::other);
  void add(v1::Act act);

  const std::function<bool(std::string_view)> wants_;
  const std::uint64_t picture_interval_;
  const clock::time_point begin_ = clock::now();
  std::set<std::string> snapshots_;       // embedded so far: the hashes of their files
  const std::shared_ptr<Shared> shared_;  // also the thread's, which may wait for a disk forever
  std::thread thread_;
};

}  // namespace ziggurat::recorder
