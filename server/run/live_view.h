// SPDX-License-Identifier: MIT
#pragma once
// Live view of a run: the state that viewers see, and their requests.

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "channels/channels.h"
#include "network/report.h"
#include "run/options.h"
#include "run/schedule.h"
#include "supervision/callers.h"
#include "supervision/world.h"
#include "timing/phases.h"
#include "view/viewer_server.h"

namespace ziggurat::run {

/// For the first viewer, so that it sees the beginning.
constexpr std::chrono::seconds longest_wait_for_viewer{5};
std::string wait_notice();

class LiveView {
 public:
  using clock = std::chrono::steady_clock;

  /// Run, or replay of one, that viewers see and change; all must outlive this.
  struct Run {
    supervision::World& world;
    Schedule& schedule;
    std::uint64_t last_tick;  ///< 0: until stopped
    /// The requests of viewers are taken there from now on.
    std::function<void(supervision::LocalCalls)> connect;
    std::function<std::uint64_t()> changes;  ///< as of supervision::Callers
    std::function<bool()> is_paused;
    std::function<clock::duration()> paused_for;  ///< wall time so far
    std::function<wire::Status()> status;
    /// Performance of each controller of the scene; none: it is not known.
    std::function<std::vector<network::Performance::Controller>()> controllers;
    /// Last values of metrics, by ROBOT/NAME.
    std::function<const std::map<std::string, double>&()> metrics;
    bool is_replay = false;  ///< viewers can't change its world
  };

  /// Listens. @throws text::UsageError, std::runtime_error
  LiveView(const Options& options, Run run);

  std::string page_address() const { return server_.page_address(); }
  const std::string& host() const { return server_.host(); }
  std::string viewer_address() const { return server_.viewer_address(); }

  /// Readable when a viewer wants something.
  int descriptor() { return server_.requests().descriptor(); }
  bool has_viewers() { return server_.requests().has_viewers(); }
  bool is_watched() { return !wanted_.empty(); }  ///< a viewer has subscribed to something

  /// Takes a published tick. At most `frames_per_second_` ticks are shown in a second of wall time.
  /// @param phases  wall time of the tick before
  void tick(const timing::PhaseTimes& phases);
  /// Some of the metrics were set at this tick.
  void measured() { has_new_metrics_ = true; }
  /// The tick was answered: its commands are known.
  void answered();
  /// A viewer wants contacts, which the next tick must list.
  bool wants_contacts() const { return wants(channels::Kind::contacts); }
  bool wants_rays() const { return wants(channels::Kind::rays); }
  /// The world began anew.
  void restarted();
  void log(channels::Severity severity, std::string_view name, std::string_view text);

  /// Takes the requests of viewers. Call it whenever the run waits, before requests are answered.
  void serve();
  /// Shows changes by requests, and the robots that the tick waits for.
  void update();
  /// The run is over: requests are refused from now on, but for the end.
  void end();
  bool shutdown_requested() const { return shutdown_; }

 private:
  void connect_callers();
  std::vector<network::Call> take_calls();
  void apply(const view::Parameter& parameter);
  void set_speed(double factor);
  void populate();
  void show_tick();
  /// Latched messages and commands, too.
  void show_all(const std::vector<std::uint32_t>& wanted);
  void show_barrier();
  void show_metrics();
  bool wants(channels::Kind kind) const { return kinds_.test(channels::index_of(kind)); }
  channels::Moment moment() const;
  channels::Sensed sensed() const;

  const Run run_;
  view::ViewerServer server_;
  channels::Layers layers_;
  std::vector<std::uint32_t> wanted_;    ///< ids of channels, ascending
  channels::Kinds kinds_;                ///< of these
  std::vector<std::uint32_t> fresh_;     ///< of these: not shown since a viewer subscribed
  std::vector<view::ViewerCall> calls_;  ///< not taken yet
  std::map<std::uint64_t, view::ViewerCall> unanswered_;  ///< by Request::id
  std::uint64_t next_call_ = 1, seen_changes_ = 0;
  timing::PhaseTimes phases_;
  double frames_per_second_ = 60;
  clock::time_point last_frame_{}, last_barrier_{}, last_fresh_{};
  bool is_current_ = false;  ///< the present tick was shown
  bool has_new_metrics_ = false;
  bool is_gathered_ = false, is_over_ = false, shutdown_ = false;
  const world::FloorImage* shown_image_ = nullptr;  ///< of a director
  std::optional<wire::Status::Phase> phase_;
};

}  // namespace ziggurat::run
