// SPDX-License-Identifier: MIT
#include "program/director_runner.h"

#include <cstdio>
#include <memory>
#include <new>
#include <string>

#include "program/echo.h"
#include "program/file_share.h"
#include "program/find_script.h"
#include "program/terminal.h"
#include "script/director_script.h"
#include "script/interrupt.h"
#include "text/printable.h"
#include "ziggurat/error.h"

namespace ziggurat::lua {
namespace {

class DirectorRunner {
 public:
  DirectorRunner(Director& director, const ProgramOptions& options)
      : director_(director), options_(options), folders_(options.folders, options.exceptions) {}

  bool run() {
    Failure failure = run_to_end();
    if (!failure && script_ && !are_scripts_interrupted()) {
      failure = script_->destroy();
      hand_over_log();
    }
    const bool has_failed = failure && !are_scripts_interrupted();
    if (has_failed) {
      if (!options_.quiet) {
        std::fprintf(stderr, "director '%s': %s\n", text::printable(director_.id()).c_str(),
                     text::printable(*failure + where_).c_str());
      }
      director_.leave_failed(*failure);
    } else {
      director_.leave();
    }
    return !has_failed;
  }

 private:
  Failure run_to_end() {
    Failure failure;
    while (!failure && !are_scripts_interrupted() && hears_of_next(failure)) {
      for (const std::string& warning : director_.take_warnings()) {
        director_.log_error((script_ ? script_->before_error_of(warning) : std::string()) +
                            warning);
      }
      failure = script_ ? answer() : start();
      if (script_) hand_over_log();
      offer_to_terminal();
    }
    return failure;
  }

  /// @param failure  what is wrong with what the script asked for, if anything
  bool hears_of_next(Failure& failure) {
    try {
      return director_.next();
    } catch (const ProtocolError& error) {
      if (!script_) throw;
      failure = script_->before_error_of(error.details().field) + error.what() +
                " (asked for at tick " + std::to_string(director_.tick()) + ")";
      return false;
    }
  }

  Failure start() {
    const FoundScript script = options_.script ? FoundScript{*options_.script, {}, {}}
                                               : find_script(director_.script(), director_.params(),
                                                             {folders_, options_.names_any_ending});
    where_ = script.where;
    if (script.path.empty()) return script.fault;
    try {
      script_ = std::make_unique<DirectorScript>(
          director_,
          ScriptOptions{script.path, director_.seed(), director_.tick(), options_.max_memory,
                        options_.max_instructions, options_.max_computing,
                        options_.trusts_scripts ? nullptr : &folders_, share_of_files(1)});
    } catch (const std::bad_alloc&) {
      return "no memory for a Lua state";
    }
    return script_->start();
  }

  Failure answer() {
    if (director_.event() == Event::reset) return script_->reset(director_.seed());
    return script_->step();
  }

  void hand_over_log() {
    LogLines& log = script_->log();
    if (options_.echo) echo(log, director_.tick(), director_.id());
    if (move_log(log, director_)) return;
    report_lost_log(director_.tick());
  }

  Director& director_;
  const ProgramOptions& options_;
  const Folders folders_;
  std::string where_;                       // a script was looked for in vain, for people here
  std::unique_ptr<DirectorScript> script_;  // from the first tick on
};

}  // namespace

bool run_director(Director& director, const ProgramOptions& options) {
  return DirectorRunner(director, options).run();
}

}  // namespace ziggurat::lua
