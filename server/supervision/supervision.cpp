// SPDX-License-Identifier: MIT
#include "supervision/supervision.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <string_view>
#include <unordered_map>

#include "math/hash.h"
#include "network/glob.h"
#include "supervision/moves.h"
#include "wire/messages.h"

namespace ziggurat::supervision {

using Kind = wire::Request::Kind;
using wire::ErrorCode;

namespace {

void write_outputs(const Supervision::Settings& settings) {
  if (settings.write_outputs) settings.write_outputs();
}

/// The entities that a read request asks for, in scene order, or the pattern that names none.
struct Selection {
  std::vector<std::size_t> entities;
  std::optional<std::string> unknown;
};

Selection select(const std::vector<std::string>& patterns, const simulation::Simulation& world) {
  const auto& all = world.layout().entities;
  std::vector<bool> is_selected(all.size(), patterns.empty());
  Selection selection;
  std::unordered_map<std::string_view, std::size_t> places;
  for (std::size_t i = 0; i < all.size() && !patterns.empty(); ++i) {
    if (!world.state().is_absent(i)) places[all[i].id] = i;
  }
  for (const std::string& pattern : patterns) {
    const auto named = places.find(pattern);
    bool is_known = named != places.end();
    if (is_known) is_selected[named->second] = true;
    const network::Glob glob(network::has_wildcards(pattern) ? pattern : "");
    for (std::size_t i = 0; i < all.size() && network::has_wildcards(pattern); ++i) {
      if (world.state().is_absent(i) || !glob.matches(all[i].id)) continue;
      is_selected[i] = is_known = true;
    }
    if (!is_known && !selection.unknown) selection.unknown = pattern;
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (is_selected[i] && !world.state().is_absent(i)) selection.entities.push_back(i);
  }
  return selection;
}

/// Fault of the reason of a shutdown, if it has one.
std::optional<wire::Fault> fault_of_reason(const std::string& reason) {
  constexpr std::size_t longest = 1024;  // [bytes]
  if (reason.size() <= longest) return std::nullopt;
  return wire::make_fault(
      ErrorCode::too_large, "shutdown.reason",
      fmt::format("The reason has {} bytes; at most {} are allowed.", reason.size(), longest));
}

/// A request that waits for an answer which its own program would have to give.
wire::Fault held_up(const char* what) {
  return wire::make_fault(
      ErrorCode::out_of_state, "held_up",
      fmt::format("The world waits for a session of the same program, which waits for this {0} "
                  "instead: it would take "
                  "forever. Answer the tick first (next()), or {0} from another thread or program.",
                  what));
}

}  // namespace

void PauseTimer::update(bool is_paused) {
  if (is_paused == paused_since_.has_value()) return;
  if (is_paused) {
    paused_since_ = clock::now();
  } else {
    earlier_ += clock::now() - *paused_since_;
    paused_since_.reset();
  }
}

PauseTimer::clock::duration PauseTimer::total() const {
  return earlier_ + (paused_since_ ? clock::now() - *paused_since_ : clock::duration{});
}

Supervision::Supervision(const Settings& settings, World& world, network::Server& server,
                         Callers& callers, Population& population)
    : settings_(settings),
      world_(world),
      server_(server),
      callers_(callers),
      population_(population),
      snapshots_(settings.snapshot_folder, settings.build) {}

bool Supervision::is_halted() const { return server_.pause() == network::Pause::halted; }

void Supervision::serve() {
  paused_.update(is_halted());
  if (stepping_ && !callers_.can_hear(*stepping_)) end_steps();
  for (network::Call& call : callers_.take()) waiting_.push_back(std::move(call));
  answer_waiting(waiting_, callers_, [this](const network::Call& call) { return handle(call); });
}

Reply Supervision::handle(const network::Call& call) {
  switch (call.request.kind) {
    case Kind::status:
      server_.answer_question(call, [&](wire::Outbox& outbox) { outbox.response(0, status()); });
      return Reply::given;
    case Kind::read:
      return read(call);
    case Kind::pause:
      return pause(call);
    case Kind::resume:
      return resume(call);
    case Kind::step:
      return step(call);
    case Kind::reset:
      return reset(call);
    case Kind::move:
    case Kind::set_joint:
      return move(call);
    case Kind::is_free: {
      auto overlapped = population_.overlapped(call.request);
      if (auto* fault = std::get_if<wire::Fault>(&overlapped)) return fail(call, std::move(*fault));
      server_.answer(call, [&](wire::Outbox& outbox) {
        outbox.response(call.request.id, world_.simulation.state().tick,
                        std::get<std::string>(overlapped));
      });
      return Reply::given;
    }
    case Kind::spawn:
      return spawn(call);
    case Kind::remove:
      return remove(call);
    case Kind::snapshot:
      return snapshot(call);
    case Kind::restore:
      return restore(call);
    case Kind::shutdown:
      if (auto fault = fault_of_reason(call.request.text)) return fail(call, std::move(*fault));
      if (!shutdown_) shutdown_ = call.request.text;
      return done(call);
    default:
      return fail(call, wire::make_fault(ErrorCode::unimplemented, {},
                                         "This server does not know that request."));
  }
}

Reply Supervision::pause(const network::Call& call) {
  constexpr std::chrono::milliseconds in_flight{
      300};  // for an answer that was sent before the request
  const auto now = std::chrono::steady_clock::now();
  const bool was_paused = server_.pause() != network::Pause::none;
  const bool waits = !is_halted() && is_gathered_;
  if (waits && network::need_of(server_, call.request.held_up) == network::Need::answer) {
    const bool is_known =
        held_up_ && held_up_->peer == call.peer && held_up_->id == call.request.id;
    if (!is_known) held_up_ = HeldUp{call.peer, call.request.id, now, was_paused};
    server_.set_paused(true);  // the world stands behind that answer
    if (now - held_up_->since < in_flight) return Reply::later;
    server_.set_paused(std::exchange(held_up_, std::nullopt)->was_paused);
    return fail(call, held_up("pause"));
  }
  const bool was_asked = (held_up_ ? held_up_->was_paused : was_paused) || steps_left_ > 0;
  held_up_.reset();
  steps_left_ = 0;
  server_.set_paused(true);
  if (!was_asked) callers_.tell(Paused{});  // it may be handled again until the world is halted
  paused_.update(is_halted());
  // Before tick 0 nothing moves: the world will stand there.
  if (!is_halted() && is_gathered_) return Reply::later;
  write_outputs(settings_);
  return done(call);
}

/// A step that still runs ends here: its supervisor is told that the world is not paused.
Reply Supervision::resume(const network::Call& call) {
  stepping_.reset();
  held_up_.reset();
  steps_left_ = 0;
  server_.set_paused(false);
  callers_.tell(Resumed{});
  paused_.update(is_halted());
  return done(call);
}

/// The world is paused again, when the current tick is complete at the latest.
void Supervision::end_steps() {
  stepping_.reset();
  if (steps_left_ == 0) return;
  steps_left_ = 0;
  server_.set_paused(true);
  paused_.update(is_halted());
}

Reply Supervision::step(const network::Call& call) {
  if (stepping_ && stepping_->peer == call.peer && stepping_->session == call.session &&
      stepping_->request.id == call.request.id) {
    const bool is_over = steps_left_ == 0 && is_halted();
    if (!is_over) return Reply::later;
    stepping_.reset();
    write_outputs(settings_);
    return done(call);
  }
  if (call.request.ticks == 0) {
    return fail(call, wire::make_fault(ErrorCode::bad_value, "step.ticks",
                                       "A step has at least one tick."));
  }
  if (server_.pause() != network::Pause::none &&
      network::need_of(server_, call.request.held_up) != network::Need::nothing) {
    return fail(call, held_up("step"));
  }
  if (stepping_) return Reply::later;
  if (server_.pause() == network::Pause::none) {
    return fail(call,
                wire::make_fault(ErrorCode::out_of_state, {},
                                 "The world is not paused; send a Pause request before a Step."));
  }
  // It will stand: at tick 0, or when the current tick is complete.
  if (!is_gathered_ || !is_halted()) return Reply::later;
  stepping_ = call;
  steps_left_ = call.request.ticks;
  server_.set_paused(false);
  paused_.update(is_halted());
  return Reply::later;
}

/// Answered by restart().
Reply Supervision::reset(const network::Call& call) {
  if (resetting_) return Reply::later;
  if (call.request.seed == std::uint64_t{0}) {
    return fail(call,
                wire::make_fault(
                    ErrorCode::bad_value, "reset.seed",
                    "The seed is 0; write a seed from 1 on, or none to keep the present one."));
  }
  resetting_ = call;
  return Reply::given;
}

Reply Supervision::read(const network::Call& call) {
  const simulation::Simulation& simulation = world_.simulation;
  server_.answer_question(call, [&](wire::Outbox& outbox) {
    const Selection selection = select(call.request.entities, simulation);
    if (selection.unknown) {
      wire::Fault fault = no_entity("read.entities", *selection.unknown);
      fault.tick = simulation.state().tick;
      return outbox.response(0, fault);
    }
    outbox.response(0, simulation.layout(), simulation.state(), selection.entities,
                    math::to_hex(simulation.hash()));
  });
  return Reply::given;
}

Reply Supervision::move(const network::Call& call) {
  const auto entity = entity_named(world_.simulation, call.request.text);
  const bool is_move = call.request.kind == Kind::move;
  if (!entity)
    return fail(call, no_entity(is_move ? "move.entity" : "set_joint.entity", call.request.text,
                                &world_.simulation));
  auto fault = supervision::move(world_.simulation, callers_, *entity, call.request);
  return fault ? fail(call, std::move(*fault)) : done(call);
}

Reply Supervision::spawn(const network::Call& call) {
  auto fault = population_.spawn(call.request.text);
  return fault ? fail(call, std::move(*fault)) : done(call);
}

Reply Supervision::remove(const network::Call& call) {
  auto fault = population_.remove(call.request.text);
  return fault ? fail(call, std::move(*fault)) : done(call);
}

Reply Supervision::fail(const network::Call& call, wire::Fault fault) {
  fault.tick = world_.simulation.state().tick;
  callers_.refused(call, fault);
  return Reply::given;
}

Reply Supervision::done(const network::Call& call) {
  callers_.done(call, world_.simulation.state().tick);
  return Reply::given;
}

void Supervision::published() {
  paused_.update(is_halted());
  if (steps_left_ > 0 && --steps_left_ == 0) server_.set_paused(true);
}

wire::Status Supervision::status() const {
  const world::State& state = world_.simulation.state();
  wire::Status status;
  status.tick = state.tick;
  status.time_ns = state.time_ns;
  // Before tick 0 a world that was paused stands, though robots may be without controller.
  const bool is_paused = is_gathered_ ? is_halted() : server_.pause() != network::Pause::none;
  status.phase = is_paused      ? wire::Status::Phase::paused
                 : is_gathered_ ? wire::Status::Phase::running
                                : wire::Status::Phase::gathering;
  status.is_hardware_in_the_loop = settings_.is_hardware_in_the_loop;
  status.seed = world_.seed;
  status.scene = world_.path;
  status.scene_hash = world_.scene_hash;
  status.last_tick = settings_.last_tick;
  server_.fill(status);
  budget_.fill(status);
  status.solver = solver_status(world_.simulation);
  status.wall_uptime_s = std::chrono::duration<double>(clock::now() - start_).count();
  return status;
}

}  // namespace ziggurat::supervision
