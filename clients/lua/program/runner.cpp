// SPDX-License-Identifier: MIT
#include "program/runner.h"

#include <new>

#include "program/echo.h"
#include "program/file_share.h"
#include "program/find_script.h"
#include "program/terminal.h"
#include "program/turn.h"
#include "script/interrupt.h"
#include "text/printable.h"

namespace ziggurat::lua {
namespace {

// A server names the robots, and how many there are.
constexpr std::size_t most_told = 100;
constexpr std::size_t longest_id = 1024;
// [s] for each destroy() at the end, where a program waits 5 s for all: one that does not end
// leaves the others time.
constexpr std::uint64_t longest_destroy = 3;

}  // namespace

Runner::Runner(ziggurat::Session& session, const ProgramOptions& options)
    : session_(session),
      options_(options),
      folders_(options.folders, options.exceptions),
      arena_(session.robots().size()) {
  for (ziggurat::Robot& robot : session_.robots()) seats_.push_back({&robot, nullptr});
}

void Runner::run() {
  bool has_started = false;
  while (!are_scripts_interrupted() && session_.next()) {
    const Turn turn;
    for (Seat& seat : seats_) {
      if (are_scripts_interrupted()) return;
      if (!has_started) start(seat);
      if (has_started && seat.controller) seat.robot->gone() ? end(seat) : answer(seat);
    }
    has_started = true;
    offer_to_terminal();
  }
  const Turn turn;
  if (!are_scripts_interrupted()) finish();
  // To free the states of many robots takes seconds: the world does not wait for that.
  session_.leave();
  for (Seat& seat : seats_) seat.controller.reset();
}

void Runner::start(Seat& seat) {
  const FoundScript script = options_.script
                                 ? FoundScript{*options_.script, {}, {}}
                                 : find_script(seat.robot->script(), seat.robot->params(),
                                               {folders_, options_.names_any_ending});
  if (script.path.empty()) return fail(seat, script.fault, script.where);
  try {
    seat.controller = std::make_unique<Controller>(
        *seat.robot,
        ScriptOptions{script.path, session_.seed(), session_.tick(), options_.max_memory,
                      options_.max_instructions, options_.max_computing,
                      options_.trusts_scripts ? nullptr : &folders_, share_of_files(seats_.size()),
                      &arena_});
  } catch (const std::bad_alloc&) {
    return fail(seat, "no memory for a Lua state");
  }
  const Failure failure = seat.controller->start();
  hand_over_log(seat);
  if (failure) fail(seat, *failure);
}

void Runner::answer(Seat& seat) {
  const Failure failure = call(*seat.controller);
  hand_over_log(seat);
  if (failure) fail(seat, *failure);
}

Failure Runner::call(Controller& controller) {
  if (session_.event() == ziggurat::Event::reset) return controller.reset(session_.seed());
  return controller.step(session_.tick());
}

void Runner::finish() {
  for (Seat& seat : seats_) {
    if (are_scripts_interrupted()) return;
    if (seat.controller) destroy(seat, options_.place_file.empty() ? 0 : longest_destroy);
  }
}

// Frees the memory and the open files of the script.
void Runner::end(Seat& seat) {
  destroy(seat);
  seat.controller.reset();
}

void Runner::destroy(Seat& seat, std::uint64_t max_seconds) {
  const Failure failure = seat.controller->destroy(session_.tick(), max_seconds);
  hand_over_log(seat);
  if (failure) fail(seat, *failure);
}

void Runner::hand_over_log(Seat& seat) {
  LogLines& log = seat.controller->log();
  if (options_.echo) echo(log, session_.tick(), seat.robot->id());
  if (move_log(log, *seat.robot)) return;
  report_lost_log(session_.tick());
}

// A script that was ended by a signal has not failed.
void Runner::fail(Seat& seat, const std::string& message, const std::string& only_here) {
  seat.controller.reset();
  if (are_scripts_interrupted()) return;
  ++failures_;
  seat.robot->fail(message);
  if (options_.quiet || failures_ > most_told + 1) return;  // the server prints it
  if (failures_ > most_told) {
    std::fprintf(stderr, "ziggurat-lua: more robots fail; their messages are not printed here\n");
    return;
  }
  std::fprintf(stderr, "robot '%s': %s\n",
               text::printable_part(seat.robot->id(), longest_id).c_str(),
               text::printable_part(message + only_here).c_str());
}

}  // namespace ziggurat::lua
