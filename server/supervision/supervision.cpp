#include "supervision/supervision.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "math/hash.h"
#include "network/glob.h"
#include "wire/fault.h"

namespace ziggurat::supervision {

using Kind = wire::Request::Kind;
using wire::ErrorCode;

namespace {

constexpr const char* phase_names[] = {"exchange", "physics", "recording", "pacing"};

bool is_finite(const std::vector<double>& values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

}  // namespace

Supervision::Supervision(const Subject& subject) : subject_(subject), room_(subject.room) {}

/// Those of one connection are answered in their order; a later one of another does not wait.
void Supervision::serve() {
  note_standing();
  if (stepping_ && !subject_.server.can_hear(*stepping_)) stepping_.reset();  // its steps go on
  for (network::Call& call : subject_.server.take_calls()) waiting_.push_back(std::move(call));
  std::vector<std::string> busy;  // connections whose turn it is not yet
  std::erase_if(waiting_, [&](const network::Call& call) {
    if (!subject_.server.can_hear(call)) return true;
    if (std::ranges::find(busy, call.peer) != busy.end()) return false;
    if (try_to(call) == Reply::given) return true;
    busy.push_back(call.peer);
    return false;
  });
}

Supervision::Reply Supervision::try_to(const network::Call& call) {
  switch (call.request.kind) {
    case Kind::status:
      subject_.server.answer(
          call, [&](wire::Outbox& outbox) { outbox.response(call.request.id, status()); });
      return Reply::given;
    case Kind::read:
      return read(call);
    case Kind::pause:
      return pause(call);
    case Kind::resume:
      stepping_.reset();  // whoever waits for its end is told that the world is not paused
      steps_left_ = 0;
      subject_.server.resume();
      note_standing();
      return done(call);
    case Kind::step:
      return step(call);
    case Kind::reset:
      return reset(call);
    case Kind::move:
      return move(call);
    case Kind::spawn:
      return spawn(call);
    case Kind::remove:
      return remove(call);
    case Kind::shutdown:
      shutdown_ = true;
      return done(call);
    default:
      return fail(call, ErrorCode::unimplemented, {}, "This server does not do that yet.");
  }
}

Supervision::Reply Supervision::pause(const network::Call& call) {
  steps_left_ = 0;
  subject_.server.pause();
  note_standing();
  return subject_.server.paused() ? done(call) : Reply::later;
}

Supervision::Reply Supervision::step(const network::Call& call) {
  if (stepping_ && stepping_->peer == call.peer && stepping_->request.id == call.request.id) {
    const bool over = steps_left_ == 0 && subject_.server.paused();
    if (!over) return Reply::later;
    stepping_.reset();
    return done(call);
  }
  if (stepping_) return Reply::later;
  if (call.request.ticks == 0) {
    return fail(call, ErrorCode::bad_value, "step.ticks", "A step has at least one tick.");
  }
  if (!subject_.server.paused()) {
    return fail(call, ErrorCode::out_of_state, {}, "The world is not paused.");
  }
  stepping_ = call;
  steps_left_ = call.request.ticks;
  subject_.server.resume();
  note_standing();
  return Reply::later;
}

/// Answered by reset_done(). Another seed may distribute entities so that they don't fit: then the
/// world goes on as it is.
Supervision::Reply Supervision::reset(const network::Call& call) {
  if (resetting_) return Reply::later;
  const std::uint64_t seed = call.request.seed.value_or(subject_.seed);
  if (seed == 0) {
    return fail(call, ErrorCode::bad_value, "reset.seed", "A seed of 0 is none.");
  }
  try {
    if (seed != subject_.seed) simulation::Simulation(subject_.scene, {seed, subject_.clock});
  } catch (const scene::SceneError& error) {
    return fail(call, ErrorCode::bad_value, "reset.seed", error.what());
  }
  resetting_ = call;
  return Reply::given;
}

Supervision::Reply Supervision::read(const network::Call& call) {
  const world::Layout& layout = subject_.simulation.layout();
  const auto is_absent = [&](std::size_t entity) {
    return subject_.simulation.state().is_absent(entity);
  };
  std::vector<std::size_t> entities;
  if (call.request.entities.empty()) {
    entities.resize(layout.entities.size());
    std::iota(entities.begin(), entities.end(), std::size_t{0});
    std::erase_if(entities, is_absent);
  }
  for (const std::string& pattern : call.request.entities) {
    const std::size_t before = entities.size();
    for (std::size_t i = 0; i < layout.entities.size(); ++i) {
      if (is_absent(i)) continue;
      const std::string& id = layout.entities[i].id;
      if (id == pattern || network::matches(pattern, id)) entities.push_back(i);
    }
    if (entities.size() == before) {
      return fail(call, ErrorCode::unknown_entity, "read.entities",
                  fmt::format("There is no entity '{}'.", pattern));
    }
  }
  std::ranges::sort(entities);
  entities.erase(std::unique(entities.begin(), entities.end()), entities.end());
  const std::string hash = math::to_hex(subject_.simulation.hash());
  subject_.server.answer(call, [&](wire::Outbox& outbox) {
    outbox.response(call.request.id, layout, subject_.simulation.state(), entities, hash);
  });
  return Reply::given;
}

Supervision::Reply Supervision::move(const network::Call& call) {
  const wire::Request& request = call.request;
  const auto entity = entity_named(request.text);
  if (!entity) {
    return fail(call, ErrorCode::unknown_entity, "move.entity",
                fmt::format("There is no entity '{}'.", request.text));
  }
  if (request.position.size() != 3 || !is_finite(request.position)) {
    return fail(call, ErrorCode::bad_value, "move.position", "x, y, z are due, finite.");
  }
  math::Pose pose = subject_.simulation.state().origins[*entity];
  pose.position = {request.position[0], request.position[1], request.position[2]};
  if (!request.orientation.empty()) {
    const auto& q = request.orientation;
    const double norm = std::sqrt(std::inner_product(q.begin(), q.end(), q.begin(), 0.0));
    if (q.size() != 4 || !std::isfinite(norm) || norm < 1e-6) {
      return fail(call, ErrorCode::bad_value, "move.orientation",
                  "A quaternion w, x, y, z is due, finite and not zero.");
    }
    pose.orientation = math::Quaternion(q[0], q[1], q[2], q[3]).normalized();
  }
  subject_.simulation.move(*entity, pose);
  return done(call);
}

Supervision::Reply Supervision::fail(const network::Call& call, ErrorCode code, std::string field,
                                     std::string message) {
  wire::Fault fault = wire::make_fault(code, std::move(field), std::move(message));
  fault.tick = subject_.simulation.state().tick;
  subject_.server.answer(call,
                         [&](wire::Outbox& outbox) { outbox.response(call.request.id, fault); });
  return Reply::given;
}

Supervision::Reply Supervision::done(const network::Call& call) {
  const std::uint64_t tick = subject_.simulation.state().tick;
  subject_.server.answer(call,
                         [&](wire::Outbox& outbox) { outbox.response(call.request.id, tick); });
  return Reply::given;
}

std::optional<std::size_t> Supervision::entity_named(const std::string& id) const {
  const auto& entities = subject_.simulation.layout().entities;
  for (std::size_t i = 0; i < entities.size(); ++i) {
    if (entities[i].id == id && !subject_.simulation.state().is_absent(i)) return i;
  }
  return std::nullopt;
}

void Supervision::published() {
  note_standing();
  if (steps_left_ > 0 && --steps_left_ == 0) subject_.server.pause();
}

void Supervision::charge(Phase phase, double seconds) {
  budget_[static_cast<std::size_t>(phase)].add(seconds, subject_.simulation.state().tick);
}

std::optional<std::uint64_t> Supervision::reset_wanted() const {
  if (!resetting_) return std::nullopt;
  return resetting_->request.seed.value_or(subject_.seed);
}

void Supervision::reset_done() {
  subject_.seed = *reset_wanted();
  forget_spawned();
  done(*resetting_);
  resetting_.reset();
}

void Supervision::note_standing() {
  const bool stands = subject_.server.paused();
  if (stands == standing_since_.has_value()) return;
  if (stands) {
    standing_since_ = clock::now();
  } else {
    stood_ += clock::now() - *standing_since_;
    standing_since_.reset();
  }
}

Supervision::clock::duration Supervision::paused_for() const {
  return stood_ + (standing_since_ ? clock::now() - *standing_since_ : clock::duration{});
}

wire::Status Supervision::status() const {
  wire::Status status;
  status.tick = subject_.simulation.state().tick;
  status.time_ns = subject_.simulation.state().time_ns;
  status.phase = !is_gathered_              ? wire::Status::Phase::gathering
                 : subject_.server.paused() ? wire::Status::Phase::paused
                                            : wire::Status::Phase::running;
  status.is_hardware_in_the_loop = subject_.is_hardware_in_the_loop;
  status.seed = subject_.seed;
  status.scene = subject_.path;
  status.scene_hash = subject_.scene_hash;
  status.last_tick = subject_.last_tick;
  subject_.server.fill(status);
  for (std::size_t i = 0; i < budget_.size(); ++i) {
    if (budget_[i].count() > 0) status.budget.push_back({phase_names[i], budget_[i].recent()});
  }
  status.wall_uptime_s = std::chrono::duration<double>(clock::now() - start_).count();
  return status;
}

}  // namespace ziggurat::supervision
