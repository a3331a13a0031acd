// SPDX-License-Identifier: MIT
#pragma once
// A run as an MCAP file (docs/recordings.md): which messages it has, in which order and chunks. No
// threads here.

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "channels/channels.h"
#include "channels/copies.h"
#include "recording/inputs.h"
#include "recording/mcap/writer.h"
#include "recording/recorder/start.h"
#include "world/metric.h"

namespace ziggurat::recorder {

/// A killed run loses no more than that, and four ticks: of all messages [bytes], and of wall time.
/// Chunks end a little before. What supervisors did since the last tick, in a pause for example, is
/// lost with it.
inline constexpr std::size_t most_unwritten = std::size_t{1} << 20;
inline constexpr std::chrono::milliseconds longest_unwritten{1000};

/// Topics of a run that are kept. `/run` and `/inputs` always are.
struct Contents {
  std::function<bool(std::string_view topic)> wants;  ///< of the other topics; empty: all
  std::uint64_t picture_interval = 1;                 ///< pictures of each Nth tick
};

/// Whether it can be kept: what is true of the wall clock only is not.
bool is_recorded(channels::Kind kind);

class Recording {
 public:
  using clock = std::chrono::steady_clock;

  /// Writes the start, with the embedded files.
  Recording(mcap::Sink sink, mcap::Compression compression, Contents contents, const Start& start);

  /// When what follows happened; now, until it is said.
  void set_now(clock::time_point now) { now_ = now; }
  /// Who is in the world from the next tick on.
  void populate(std::shared_ptr<const channels::PopulationCopy> population);
  /// A state was published. @param copy  gets memory that is not needed any more
  void tick(channels::TickCopy& copy);
  /// Between the last tick and the next, or before the first one.
  void add(v1::Act act);
  void log(channels::Severity severity, const std::string& name, const std::string& text);
  void attach(const EmbeddedFile& file);
  /// Adds metrics that controllers have set between the last tick and the next.
  void measured(const std::vector<world::Metric>& metrics);
  /// The world is stepped with these commands.
  void step(const world::Commands& commands);
  /// A new epoch begins: after a reset, for example.
  void end_epoch();

  /// Ends the chunk if it has lasted nearly a second, or is full. Call it now and then.
  void end_due_chunk();
  void close();

  std::size_t chunks() const { return writer_.chunks(); }  ///< that are written
  std::size_t chunk_size() const {
    return writer_.chunk_size();
  }  ///< of what is not written [bytes]
  clock::time_point chunk_begin() const { return chunk_begin_; }  ///< if that is more than 0

 private:
  void write(std::uint16_t channel, std::string_view bytes);
  std::uint16_t add_channel(const google::protobuf::Descriptor& type, const std::string& topic);
  std::uint16_t add_channel(const channels::Schema& schema, const std::string& topic);
  void write_messages(channels::Pace pace);
  void write_inputs();
  void end_chunk();
  bool takes_pictures() const;

  mcap::Writer writer_;
  const Contents contents_;
  std::map<std::string, std::uint16_t> schemas_;                    // by the name of the type
  std::map<std::string, std::uint16_t> topics_;                     // channels in the file
  std::map<std::uint32_t, std::uint16_t> channels_of_;              // by Channel::id
  std::uint16_t run_ = 0, inputs_channel_ = 0, state_channel_ = 0;  // 0: not wanted
  std::shared_ptr<const channels::PopulationCopy> population_;      // that channels_ refers to
  channels::Channels channels_;
  std::vector<std::uint32_t> wanted_, without_pictures_;  // Channel::id, ascending
  bool is_population_new_ = false;
  channels::TickCopy tick_;  // the last one
  v1::Inputs inputs_;
  v1::Inputs early_;         // acts that come before the next state, the first of an epoch
  bool has_inputs_ = false;  // of the last tick, not written yet
  recording::CommandPacker commands_;
  recording::StatePacker links_;
  v1::ExactState exact_;  // keeps its memory
  std::uint64_t epoch_ = 0;
  std::int64_t offset_ns_ = 0;    // of log times from simulated time
  std::int64_t log_time_ns_ = 0;  // of the last tick
  bool begins_epoch_ = true;
  clock::time_point now_ = clock::now(), chunk_begin_{};
};

}  // namespace ziggurat::recorder
