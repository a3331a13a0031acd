// SPDX-License-Identifier: MIT
#pragma once
// Setup of a run before it has a world, and messages to clients at its start and end.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "network/server.h"
#include "reports/console.h"
#include "reports/summary.h"
#include "run/live_view.h"
#include "run/local_endpoints.h"
#include "run/options.h"
#include "scene/scene.h"
#include "supervision/supervision.h"

namespace ziggurat::run {

/// Network configuration from the options, before the scene is read.
/// @param is_serve  listens in a folder of this user if the options name no endpoint
/// @param local     makes the folders of sockets
/// @throws network::KeyError
network::Config network_config(const Options& options, bool is_serve, LocalEndpoints& local);

/// Adds what the scene and the options say of each controller: deadlines and injected delays.
/// @throws text::UsageError
void add_controllers(const Options& options, const scene::Scene& scene, network::Config& config);

/// Prints the endpoints on stdout, for programs that start the server.
void announce(const Options& options, const std::vector<std::string>& endpoints,
              reports::Console& console);

/// A line on each kind of program that the world waits for: scripts, and the programs of
/// controllers and directors.
void tell_how_to_connect(const Options& options, const std::string& listens_at,
                         const supervision::World& world, reports::Console& console);

/// Description of a run for its clients. Refers to both arguments.
/// @param scripts  per robot of the scene; empty = none
wire::Run description_of(const supervision::World& world, const std::vector<std::string>& scripts);

/// Whether serve starts a director of the scene.
bool starts_directors(const Options& options, const scene::Scene& scene);

/// Checks that all directors can be started. @throws scene::SceneError that names those without
/// script and command
void check_programs(const scene::Scene& scene);

/// Number of threads for the physics: what the options say, else as many as bodies that move are
/// worth, up to the processors. Local controllers need none of them: they wait while the physics
/// computes.
unsigned threads_for(const Options& options, std::span<const scene::Entity> entities);
/// Number of processes that share the Lua robots, without option as many as keep enough of them
/// busy where the physics has a thread.
unsigned lua_processes_for(const Options& options, unsigned threads, std::size_t robots);

/// Message to clients at the end of the run.
wire::End end_message(const reports::Summary& summary);

/// Ends the program on Ctrl-C before there is a world. The thread that loads it has nothing to
/// clean up, and ends with the process.
[[noreturn]] void end_while_loading();

/// A run as viewers see and change it. Everything must outlive what it is given to.
/// @param last_tick  0: until stopped
LiveView::Run shown(supervision::World& world, network::Server& server,
                    supervision::Callers& callers, supervision::Supervision& supervision,
                    Schedule& schedule, const reports::Summary& summary, std::uint64_t last_tick);

/// Serves viewers, if the options ask for that. Prints the addresses on stderr also if the run is
/// to be quiet: without them nothing can be seen.
std::unique_ptr<LiveView> make_showing(const Options& options, const LiveView::Run& run);

}  // namespace ziggurat::run
