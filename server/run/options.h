// SPDX-License-Identifier: MIT
#pragma once
// Options of a run, as plain data.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "recording/mcap/records.h"
#include "reports/gate.h"
#include "run/options/controller_option.h"
#include "run/options/deadline_option.h"
#include "run/options/inject_option.h"
#include "run/pictures.h"
#include "scene/reader.h"
#include "scene/scene.h"

namespace ziggurat::run {

struct Options {
  std::vector<std::string> scenes;  ///< exactly one for run and serve; for fork the recording
  scene::ReadOptions scene_file;

  std::optional<std::uint64_t> ticks;  ///< replaces the scene's length
  std::optional<double> duration;      ///< simulated [s], replaces the length too; 0 = until Ctrl-C
  std::optional<std::uint64_t> seed;   ///< 0 = drawn from the system
  std::optional<double> real_time;     ///< simulated seconds per second of wall time; > 0

  unsigned threads = 0;                   ///< of the physics; 0: see threads_for()
  std::optional<unsigned> lua_processes;  ///< 0 = one per robot; none: see lua_processes_for()
  std::vector<std::pair<std::string, std::string>> controllers;  ///< id, command
  std::vector<std::string> spawned_script_folders;  ///< whose files spawned robots may use, too
  std::string snapshot_folder;                      ///< for supervisors; empty = none
  std::vector<std::string> lua_arguments;           ///< for ziggurat-lua, of --lua-… options
  std::vector<std::string> endpoints;
  std::vector<DeadlineOption> deadlines;
  std::vector<InjectOption> injections;
  std::vector<RestartOption> restarts;
  double lease = 0;  ///< wall time that the robots of a lost session are kept for it [s]
  bool without_controllers = false;         ///< the robots do nothing
  std::string curve_secret, curve_clients;  ///< paths; both or none
  bool fail_fast = false;        ///< the run ends when a controller fails or a robot is dropped
  bool allow_drops = false;      ///< robots that a deadline dropped are no failure
  bool paused = false;           ///< the world is halted at tick 0 until a supervisor resumes it
  bool ends_with_input = false;  ///< the end of standard input is an interruption
  bool hil = false;              ///< hardware in the loop: paced, never waits
  std::vector<reports::Condition> gate;  ///< conditions that every controller must meet
  std::string report_card;               ///< path; empty = none
  std::uint64_t warm_up = 0;             ///< ticks that the report card does not count
  std::string metrics;                   ///< host:port; empty = none
  std::optional<std::string> view;       ///< serve viewers: host:port, or empty for the usual one
  std::string view_token;                ///< the user's own; empty = a random one
  bool allows_directors = false;         ///< also those that the scene does not name
  bool starts_all_directors = false;     ///< serve: one without a program is a fault
  bool starts_no_directors = false;      ///< serve: all of the scene's connect from outside
  bool insecure = false;                 ///< endpoints may be reached from other machines

  bool quiet = false;
  bool strict = false;  ///< check: warnings count as faults
  bool json = false;
  bool hash = false;
  std::string hash_file, trace, readings, rays, images, summary;  ///< paths; empty = none
  std::string record;  ///< path of the recording; empty = none
  mcap::Compression record_compression = mcap::Compression::zstd;
  std::vector<std::string> record_topics;  ///< patterns; empty = all
  std::uint64_t record_every = 1;          ///< pictures of each Nth tick
  bool record_strict = false;              ///< the run ends if the recording can't be written
  bool record_paths = false;  ///< paths and the command line are recorded as they were written
  std::string settings_file;  ///< path; empty = none
  std::vector<std::string> open_to_scene;  ///< options that are not given, so that <run> sets them
  std::vector<std::string> arguments;      ///< of the command line, without keys and tokens
  std::optional<PictureOptions> pictures;  ///< the run ends with the last of them
};

/// Whether the run ends with a report card.
bool wants_report_card(const Options& options);

/// The one scene of a run. @throws text::UsageError if there is none or more
const std::string& only_scene(const Options& options);

}  // namespace ziggurat::run
