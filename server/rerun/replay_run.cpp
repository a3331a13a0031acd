// SPDX-License-Identifier: MIT
#include "rerun/replay_run.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "outputs/hash_file.h"
#include "recording/replay/recording_file.h"
#include "recording/replay/scene.h"
#include "reports/json_text.h"
#include "rerun/recorded_world.h"
#include "rerun/replay_difference.h"
#include "run/files.h"
#include "run/setup.h"
#include "text/numbers.h"

namespace ziggurat::rerun {

using timing::Phase;

namespace {

constexpr int longest_sleep_ms = 100;  // viewers get their frames meanwhile

std::optional<double> factor_of(const run::Options& options) {
  if (options.real_time || !options.view) return options.real_time;
  return 1;
}

/// Refuses outputs that need a simulation, not only poses.
void check_poses_suffice(const run::Options& options) {
  const std::pair<const char*, bool> others[] = {
      {"--readings", !options.readings.empty()},   {"--rays", !options.rays.empty()},
      {"--images", !options.images.empty()},       {"--summary", !options.summary.empty()},
      {"--hash-file", !options.hash_file.empty()}, {"--hash", options.hash}};
  for (const auto& [option, is_given] : others) {
    if (!is_given) continue;
    throw text::UsageError(fmt::format(
        "--from-poses simulates nothing, and {} needs more than poses; leave out one of them",
        option));
  }
}

/// The least and the greatest tick of a recording, which may begin at a snapshot and go back.
std::pair<std::uint64_t, std::uint64_t> ticks_of(const replay::RecordingFile& file) {
  replay::States states(file);
  const v1::Inputs* next = states.next();
  if (next == nullptr) return {0, 0};
  std::pair<std::uint64_t, std::uint64_t> ticks{next->tick(), next->tick()};
  for (; next != nullptr; next = states.next()) {
    ticks = {std::min<std::uint64_t>(ticks.first, next->tick()),
             std::max<std::uint64_t>(ticks.second, next->tick())};
  }
  return ticks;
}

/// Before any output is created. A film of the recording is as long as it is, unless other ends are
/// asked for.
run::Options checked_outputs(const ReplayOptions& options, const replay::RecordingFile& file,
                             const scene::Experiment& experiment) {
  if (options.until) check_until(file, *options.until);
  run::Options outputs = options.run;
  if (!outputs.pictures || !outputs.pictures->film) return outputs;
  run::FilmOptions& film = *outputs.pictures->film;
  const auto [first, last] = ticks_of(file);
  film.from = std::max(film.from, static_cast<double>(first) / experiment.ticks_per_second);
  if (!film.to)
    film.to = static_cast<double>(options.until.value_or(last)) / experiment.ticks_per_second;
  if (*film.to < film.from) throw text::UsageError("--from is after the end of the recording");
  return outputs;
}

/// Checks the names of all files before any is created.
std::string checked(const ReplayOptions& options) {
  if (options.from_poses) check_poses_suffice(options.run);
  run::Options files = options.run;
  files.scenes = {options.recording};
  run::check_files(files);
  return options.recording;
}

}  // namespace

ReplayRun::ReplayRun(const ReplayOptions& options, processes::Signals& signals)
    : options_(options),
      signals_(signals),
      console_({options.run.quiet, options.run.json}),
      file_(checked(options)),
      world_(build_recorded(file_)),
      recorders_(checked_outputs(options, file_, world_.scene.experiment), world_),
      states_(file_),
      replay_({world_.scene, world_.additions, world_.simulation, world_.seed},
              file_.files().opener(), [this] { return states_.next(); }),
      schedule_(factor_of(options.run), world_.simulation.tick_length()),
      live_view_(run::make_showing(options.run, shown())),
      progress_(console_, world_.simulation.tick_length(), file_.states()) {
  replay_.open_snapshots_by(embedded_snapshots(file_, world_));
  options.from_poses ? show_poses() : begin_as_recorded(file_, world_);
  summary_.scene = world_.path;
  summary_.robots = world_.simulation.layout().robots.size();
  if (live_view_) {
    console_.notice(run::wait_notice());
    waits_for_viewer_until_ = clock::now() + run::longest_wait_for_viewer;
  }
}

void ReplayRun::show_poses() {
  if (!file_.reader().contents().channel_of("/state")) {
    throw text::UsageError(
        fmt::format("--from-poses: {} has no topic /state, in which the poses are "
                    "(--record-topics); replay it without",
                    file_.path()));
  }
  replay_.show([this] { return states_.links(); });
  const std::string& begin = file_.run().snapshot();
  if (begin.empty()) return;
  replay_.begin_at(replay::read_snapshot(file_, begin, world_.scene, world_.additions));
}

run::LiveView::Run ReplayRun::shown() {
  run::LiveView::Run watched{world_, schedule_, file_.run().last_tick(), {}, {}, {}, {}, {},
                             {},     {}};
  watched.connect = [this](supervision::LocalCalls calls) {
    viewer_controls_.connect(std::move(calls));
  };
  watched.changes = [this] { return replay_.changes(); };
  watched.is_paused = [this] { return viewer_controls_.is_paused(); };
  watched.paused_for = [this] { return viewer_controls_.paused_for(); };
  watched.status = [this] { return status(); };
  watched.is_replay = true;
  watched.metrics = [this]() -> const auto& { return summary_.metrics; };
  watched.controllers = [] { return std::vector<network::Performance::Controller>(); };
  return watched;
}

wire::Status ReplayRun::status() const {
  wire::Status status;
  status.tick = world_.simulation.state().tick;
  status.time_ns = world_.simulation.state().time_ns;
  status.phase =
      viewer_controls_.is_paused() ? wire::Status::Phase::paused : wire::Status::Phase::running;
  status.seed = world_.seed;
  status.scene = world_.path;
  status.scene_hash = world_.scene_hash;
  status.last_tick = file_.run().last_tick();
  status.solver = supervision::solver_status(world_.simulation);
  return status;
}

int ReplayRun::execute() {
  End end = End::damaged;
  try {
    end = repeat();
    if (same_ == 0 && end == End::complete) {  // each recording has the state of tick 0
      is_empty_ = file_.shortcoming().empty();
      damage_ =
          is_empty_ ? "it holds no tick: the run ended before its first" : file_.shortcoming();
      end = End::damaged;
    }
  } catch (const replay::RecordingError& error) {
    damage_ = error.what();
  } catch (const mcap::Damaged& error) {
    damage_ = error.what();
  }
  recorders_.close();
  complete_summary(end);
  recorders_.write_summary(summary_);
  if (!options_.verifies && !options_.from_poses) {
    console_.report(options_.run.json ? to_json(summary_) : to_text(summary_));
  }
  tell(end);
  for (const auto& picture : recorders_.pictures()) console_.result(picture);
  if (const auto missing = recorders_.missing_frames(); !missing.empty()) console_.warning(missing);
  if (options_.run.hash) console_.result(outputs::hash_line(summary_.ticks, summary_.hash));
  console_.flush();
  if (live_view_ && end != End::stopped) show_end();
  switch (end) {
    case End::complete:
      return reports::exit_code::finished;
    case End::differs:
      return reports::exit_code::differs;
    case End::damaged:
      return reports::exit_code::damaged;
    case End::stopped:
      break;
  }
  return viewer_controls_.is_over() ? reports::exit_code::finished
                                    : reports::exit_code::interrupted;
}

/// From the first recorded state to the last one, or to the first that differs.
ReplayRun::End ReplayRun::repeat() {
  simulation::Simulation& simulation = world_.simulation;
  const bool draws_rays = options_.run.pictures && options_.run.pictures->view.layers.rays;
  std::uint64_t epoch = 0;
  for (;;) {
    watch_.enter(Phase::forces);
    if (!replay_.advance(&watch_)) return End::complete;
    watch_.enter(Phase::recording);
    if (!replay_.is_same()) {
      difference_ = explain_difference(file_, states_, replay_, world_);
      return End::differs;
    }
    ++same_;
    const v1::Inputs& inputs = replay_.inputs();
    if (same_ == 1 || inputs.epoch() != epoch)
      schedule_.begin(inputs.tick(), viewer_controls_.paused_for());
    if (live_view_ && inputs.epoch() != epoch) live_view_->restarted();
    if (inputs.epoch() != epoch) summary_.metrics.clear();
    epoch = inputs.epoch();
    viewer_controls_.stepped(inputs.tick());
    recorders_.tick(simulation);
    if (live_view_) live_view_->tick({});
    if (progress_.needs_update()) progress_.show(same_ - 1, "");
    if (options_.until && inputs.tick() == *options_.until) return End::complete;
    watch_.enter(Phase::pacing);
    if (!wait()) return End::stopped;
    watch_.enter(Phase::recording);
    replay_.act();
    const std::vector<world::Metric> measured = take_metrics();
    recorders_.exchange(simulation.state(), simulation.observations(), simulation.commands(),
                        measured);
    if (live_view_) {
      if (!measured.empty()) live_view_->measured();
      live_view_->answered();
      live_view_->update();
      simulation.list_contacts(live_view_->wants_contacts());
    }
    simulation.list_rays((live_view_ && live_view_->wants_rays()) || draws_rays);
  }
}

/// Metrics of the current inputs.
std::vector<world::Metric> ReplayRun::take_metrics() {
  std::vector<world::Metric> metrics;
  for (const v1::Inputs::Metric& from : replay_.inputs().metrics()) {
    metrics.push_back({from.robot(), from.name(), from.value()});
    summary_.metrics.insert_or_assign(world::key_of(metrics.back()), from.value());
  }
  return metrics;
}

void ReplayRun::serve() {
  if (!live_view_) return;
  live_view_->serve();
  viewer_controls_.serve(world_.simulation.state().tick);
  live_view_->update();
}

/// @param timeout_ms  how long to wait otherwise
bool ReplayRun::may_step(clock::time_point now, int& timeout_ms) {
  timeout_ms = longest_sleep_ms;
  if (live_view_ && now < waits_for_viewer_until_) {
    if (!live_view_->is_watched()) return false;
    waits_for_viewer_until_ = {};
    schedule_.begin(world_.simulation.state().tick, viewer_controls_.paused_for());
  }
  if (viewer_controls_.is_paused()) return false;
  const auto moment =
      schedule_.end_of(world_.simulation.state().tick, viewer_controls_.paused_for());
  if (now >= moment) return true;
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(moment - now).count();
  timeout_ms = static_cast<int>(std::min<std::int64_t>(left, longest_sleep_ms));
  return false;
}

/// Until the next step may begin. False: the replay is to end.
bool ReplayRun::wait() {
  std::vector<pollfd> items{{signals_.descriptor(), POLLIN, 0}};
  if (live_view_) items.push_back({live_view_->descriptor(), POLLIN, 0});
  for (;;) {
    if (signals_.take().interruptions > 0) return false;
    serve();
    if (viewer_controls_.is_over()) return false;
    int timeout_ms = 0;
    if (may_step(clock::now(), timeout_ms)) return true;
    console_.offer();
    ::poll(items.data(), items.size(), timeout_ms);
  }
}

void ReplayRun::show_end() {
  console_.notice("the replay is over; its last state is shown until Ctrl-C");
  console_.flush();
  live_view_->end();
  std::vector<pollfd> items{{signals_.descriptor(), POLLIN, 0},
                            {live_view_->descriptor(), POLLIN, 0}};
  while (!live_view_->shutdown_requested() && signals_.take().interruptions == 0) {
    live_view_->serve();
    live_view_->update();
    ::poll(items.data(), items.size(), longest_sleep_ms);
  }
}

void ReplayRun::complete_summary(End end) {
  const simulation::Simulation& simulation = world_.simulation;
  summary_.ending = end == End::stopped ? reports::Ending::interrupted : reports::Ending::finished;
  summary_.ticks = simulation.state().tick;
  summary_.simulated_s = static_cast<double>(summary_.ticks) * simulation.tick_length();
  summary_.wall = watch_.take();
  summary_.seed = world_.seed;
  summary_.hash = replay_.hash();
  summary_.solver = supervision::solver_status(simulation);
}

/// The verdict: the result of `verify`; a replay prints it as a message.
void ReplayRun::tell(End end) {
  const std::string states = fmt::format("{} state{}", same_, same_ == 1 ? "" : "s");
  std::string verdict = end == End::differs ? "differs" : "identical";
  std::string text = states + " as recorded";
  if (options_.from_poses) {
    verdict = "shown";
    text = states + ", nothing simulated";
  }
  if (end == End::differs) {
    text = fmt::format("{}; {} before it as recorded", difference_, states);
    for (const auto& cause : likely_causes(file_.run())) text += "\n  " + cause;
  }
  if (end == End::damaged) {
    verdict = is_empty_ ? "empty" : "damaged";
    text = is_empty_ ? damage_ : fmt::format("{}; {} before it as recorded", damage_, states);
  }
  if (end == End::stopped) verdict = "stopped";
  const std::string shortcoming = file_.shortcoming();
  if (!shortcoming.empty() && end != End::damaged) console_.warning(shortcoming);
  if (!options_.verifies) {
    const std::string line = verdict + ": " + text;
    return end == End::differs || end == End::damaged ? console_.fault(line)
                                                      : console_.report(line);
  }
  if (!options_.run.json) return console_.result(verdict + ": " + text);
  nlohmann::ordered_json json{{"verdict", verdict}, {"states", same_}, {"text", text}};
  if (end == End::differs) {
    json["tick"] = replay_.inputs().tick();
    json["epoch"] = replay_.inputs().epoch();
  }
  console_.result(reports::json_text(json));
}

}  // namespace ziggurat::rerun
