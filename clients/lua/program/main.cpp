// SPDX-License-Identifier: MIT
// ziggurat-lua: runs Lua controllers against a server.

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "program/director_runner.h"
#include "program/file_share.h"
#include "program/host.h"
#include "program/options.h"
#include "program/runner.h"
#include "program/signals.h"
#include "program/terminal.h"
#include "script/interrupt.h"
#include "script/place_file.h"
#include "text/buffered_stream.h"
#include "text/printable.h"
#include "ziggurat/director.h"
#include "ziggurat/error.h"
#include "ziggurat/session.h"

namespace {

using namespace ziggurat;

enum ExitCode { exit_finished = 0, exit_fault = 1, exit_failed_script = 3, exit_signal = 128 };

template <typename Wanted>
Wanted where(const lua::ProgramOptions& from) {
  Wanted options;
  options.endpoint = from.endpoint;
  options.server_key = from.server_key;
  options.curve_secret = from.curve_secret;
  options.session_token = from.session_token;
  options.name = from.name;
  options.version = ZIGGURAT_VERSION;
  options.is_interrupted = [] { return lua::arrived_signal() != 0; };
  return options;
}

int exit_code(const std::optional<Ending>& ending, bool has_failed,
              const lua::ProgramOptions& options) {
  if (const int number = lua::arrived_signal()) return exit_signal + number;
  if (ending && ending->reason == Ending::Reason::failed && !options.quiet) {
    std::fprintf(stderr, "ziggurat-lua: the server ended the run: %s\n",
                 text::indented(text::printable(ending->message)).c_str());
  }
  return has_failed ? exit_failed_script : exit_finished;
}

/// A robot that arrives may have been removed meanwhile, or another client may have been faster.
bool is_late(const std::string& code) {
  return code == "NOT_YOURS" || code == "UNKNOWN_ROBOT" || code == "ROBOT_TAKEN";
}

/// Robots of a list that have left the run since it was written are left out. None: all have, or
/// the one that arrives is another's.
std::unique_ptr<Session> begin(Options wanted, bool has_list, bool arrives) {
  for (;;) {
    try {
      return std::make_unique<Session>(wanted);
    } catch (const ProtocolError& error) {
      if (arrives && is_late(error.details().code)) return nullptr;
      const bool has_left = error.details().code == "NOT_YOURS";
      const auto is_it = [&](const std::string& id) {
        return text::printable_part(id) == error.details().robot;
      };
      if (!has_list || !has_left || std::erase_if(wanted.robots, is_it) == 0) throw;
      if (wanted.robots.empty()) return nullptr;
    }
  }
}

int run_robots(const lua::ProgramOptions& options) {
  auto wanted = where<Options>(options);
  wanted.controller = options.controller;
  wanted.robots = options.robots;
  wanted.lua_only = !options.script;  // --script runs robots with any controller
  const auto begun = begin(wanted, options.has_list, !options.robots_from.empty());
  if (!begun) return exit_finished;
  Session& session = *begun;
  if (!options.quiet) {
    const std::size_t robots = session.robots().size();
    std::fprintf(stderr, "ziggurat-lua: runs %zu %s at %s, seed %llu\n", robots,
                 robots == 1 ? "robot" : "robots", options.endpoint.c_str(),
                 static_cast<unsigned long long>(session.seed()));
  }
  lua::Runner runner(session, options);
  runner.run();
  session.leave();
  return exit_code(session.ending(), runner.has_failures(), options);
}

int direct(const lua::ProgramOptions& options) {
  auto wanted = where<DirectorOptions>(options);
  wanted.director = *options.director;
  wanted.groups.assign(wanted.all_groups.begin(), wanted.all_groups.end());
  Director director(wanted);
  if (!options.quiet) {
    std::fprintf(stderr, "ziggurat-lua: directs as '%s' at %s, seed %llu\n",
                 text::printable_part(director.id()).c_str(), options.endpoint.c_str(),
                 static_cast<unsigned long long>(director.seed()));
  }
  const bool is_well = lua::run_director(director, options);
  return exit_code(director.ending(), !is_well, options);
}

int run(const lua::ProgramOptions& options) {
  return options.director ? direct(options) : run_robots(options);
}

void report(const std::exception& error) {
  std::fprintf(stderr, "ziggurat-lua: %s\n",
               text::indented(text::printable_part(error.what())).c_str());
}

/// The same for one of several robots.
int run_and_report(const lua::ProgramOptions& options) {
  try {
    return run(options);
  } catch (const std::exception& error) {
    if (const int number = lua::arrived_signal()) return exit_signal + number;
    report(error);
    return exit_fault;
  }
}

}  // namespace

int main(int count, char** arguments) {
  text::prepare_output();
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
  try {
    const auto request = lua::read_arguments(count, arguments, ::isatty(STDOUT_FILENO) != 0);
    if (!request.text.empty()) {
      if (std::fputs(request.text.c_str(), stdout) >= 0 && std::fflush(stdout) == 0)
        return exit_finished;
      throw std::runtime_error(std::string("stdout cannot be written: ") + std::strerror(errno));
    }
    lua::take_terminal(!request.options.trusts_scripts);
    lua::handle_signals();
    lua::open_more_files();
    lua::watch_scripts();
    const auto& options = request.options;
    if (!options.place_file.empty()) lua::open_place_file(options.place_file);
    const int code = options.robots_from.empty()
                         ? run(options)
                         : lua::run_arriving_robots(options, run_and_report);
    lua::finish_terminal();
    return code;
  } catch (const std::exception& error) {
    if (const int number = lua::arrived_signal()) return exit_signal + number;
    report(error);
    lua::finish_terminal();
    return exit_fault;
  }
}
