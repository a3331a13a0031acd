// SPDX-License-Identifier: MIT
#include "network/server.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "network/answer_cache.h"
#include "network/barrier/admission.h"
#include "network/barrier/departure.h"
#include "network/barrier/directing.h"
#include "network/barrier/dispatch.h"
#include "network/barrier/exchange.h"
#include "network/barrier/overview.h"
#include "network/barrier/population.h"
#include "network/barrier/timeouts.h"
#include "network/disturbed_link.h"
#include "network/socket.h"

namespace ziggurat::network {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds noticeable{
    1};  // to deadlines: messages are taken for that long between looks at them

std::vector<DisturbedLink::Target> targets_of(const Config& config, const wire::Run& run) {
  std::vector<DisturbedLink::Target> targets;
  const auto add = [&](DisturbedLink::Target target) {
    if (targets.size() < config.injections.size())
      target.injection = config.injections[targets.size()];
    targets.push_back(std::move(target));
  };
  for (const scene::Controller& controller : run.controllers) add({.id = controller.id});
  for (const scene::Director& director : run.directors)
    add({.id = director.id, .is_director = true});
  return targets;
}

/// No tick goes on before a message of one that is no controller yet: the world is halted, or a
/// robot is free that the tick waits for without end.
bool waits_for_newcomer(const Barrier& barrier) {
  const bool has_free = barrier.ownership.is_awaited() || barrier.directors.ownership.is_awaited();
  const bool waits_for_robot = has_free && barrier.timers.deadline == never;
  return barrier.gate.is_halted() || waits_for_robot;
}

/// Observers and supervisors leave most of the connections to controllers.
Config with_places(Config config, std::size_t connections) {
  const auto share = [&](std::size_t part) { return std::max(std::size_t{1}, connections / part); };
  config.max_observers = std::min(config.max_observers, share(4));
  config.max_supervisors = std::min(config.max_supervisors, share(8));
  return config;
}

}  // namespace

struct Server::State {
  explicit State(const Config& config)
      : socket(config),
        barrier(
            with_places(config, socket.most_connections()),
            [this](const std::string& connection, const wire::Outbox& message) {
              return link ? link->send(connection, message, barrier.now)
                          : socket.send(connection, message);
            },
            Clock::now(),
            [this](const std::string& connection, Standing standing, std::size_t longest) {
              socket.set_standing(connection, standing, longest);
            }) {}

  template <class Done>
  Outcome wait_until(Done done, const Wait& wait, world::Commands* commands);
  template <class Done>
  bool take_messages(Done done, world::Commands* into);
  void advance(Time now);
  Time next_event() const;

  Socket socket;
  std::optional<DisturbedLink> link;
  Barrier barrier;
  AnswerCache answers;
  // Other numbers if anything that a status tells may have changed: whether a session has answered
  // the tick, or anything else.
  std::uint64_t commands = 0, changes = 0;
  bool is_opened = false;  // and clients that wait for the world are still to be answered
  Received received;
};

Server::Server(const Config& config) : state_(std::make_unique<State>(config)) {}

Server::Server(const Config& config, const wire::Run& run) : Server(config) { open(run, config); }

Server::~Server() { refuse_waiting(state_->barrier); }

/// Takes messages that have arrived until `done` or there is none. True if done.
template <class Done>
bool Server::State::take_messages(Done done, world::Commands* into) {
  if (std::exchange(is_opened, false)) admit_waiting(barrier);
  const Time end = barrier.now + noticeable;
  do {
    if (const auto held = link ? link->next(barrier.now) : std::nullopt) {
      receive(barrier, *held, into);
      ++changes;
      continue;
    }
    if (!socket.receive(received)) break;
    if (!link || link->arrives(received, barrier.now)) receive(barrier, received, into);
    if (barrier.inbox.is_answer()) {
      ++commands;
    } else {
      changes += barrier.inbox.is_question() ? 0 : 1;
    }
    const bool is_done = done();
    if (is_done || !barrier.calls.has_news()) socket.handled();  // or when the caller has answered
    if (is_done) return true;
  } while (!barrier.calls.has_news() && Clock::now() < end);
  for (const std::string& connection : socket.take_gone()) {
    // Messages that such a link still holds back arrive first; a heartbeat then finds that the
    // connection is gone.
    if (!link || !link->holds(connection)) disconnect(barrier, connection);
    ++changes;
  }
  return done();
}

void Server::State::advance(Time now) {
  if (now >= network::next_event(barrier)) ++changes;
  if (link) link->release(now);
  network::advance(barrier, now);
}

Time Server::State::next_event() const {
  const Time next = network::next_event(barrier);
  return link ? std::min(next, link->next_event()) : next;
}

template <class Done>
Outcome Server::State::wait_until(Done done, const Wait& wait, world::Commands* commands) {
  const bool is_bounded = wait.timeout.count() >= 0;
  const Time end = is_bounded ? Clock::now() + wait.timeout : never;
  // Messages that had arrived when the server last looked are not late, even if it takes them
  // later.
  Time looked = barrier.now;
  socket.handled();
  for (;;) {
    barrier.now = Clock::now();
    socket.set_ticking(commands != nullptr && barrier.gate.is_owed() &&
                       !waits_for_newcomer(barrier));
    socket.tend();
    if (take_messages(done, commands)) return Outcome::complete;
    advance(looked);
    if (done()) return Outcome::complete;
    if (barrier.calls.has_news()) return Outcome::woken;  // the caller answers
    looked = Clock::now();
    const auto rest = std::chrono::ceil<milliseconds>(std::min(end, next_event()) - looked);
    const auto ready = socket.poll(std::max(rest, milliseconds{0}), wait.descriptors);
    if (ready == Socket::Ready::woken) return Outcome::woken;
    if (Clock::now() >= end) {
      barrier.now = Clock::now();
      return take_messages(done, commands) ? Outcome::complete : Outcome::timed_out;
    }
  }
}

const std::vector<std::string>& Server::endpoints() const { return state_->socket.endpoints(); }

Outcome Server::attend(const Progress& progress, const Wait& wait) {
  state_->barrier.progress = progress;
  return state_->wait_until([] { return false; }, wait, nullptr);
}

void Server::open(const wire::Run& run, const Config& config) {
  State& state = *state_;
  if (!config.private_endpoint.empty()) state.socket.add_private(config);
  if (std::ranges::any_of(config.injections, &Injection::any)) {
    state.link.emplace(
        targets_of(config, run), run.seed, 2 * config.max_message_bytes,
        [&state](const std::string& connection, std::string_view bytes, MessageKind kind) {
          return state.socket.send(connection, bytes, kind);
        });
  }
  state.barrier.now = Clock::now();
  network::open(state.barrier, run, config);
  state.is_opened = true;
}

Outcome Server::gather(const Wait& wait) {
  const Barrier& barrier = state_->barrier;
  const auto is_gathered = [&] {
    return barrier.ownership.all_taken() && barrier.directors.ownership.all_taken();
  };
  return state_->wait_until(is_gathered, wait, nullptr);
}

void Server::publish(const world::Observations& observations,
                     const std::vector<std::string>& tag_payloads, const wire::Truth* truth) {
  state_->advance(Clock::now());
  ++state_->changes;
  network::publish(state_->barrier, observations, tag_payloads, truth);
  const Time sent = Clock::now();  // the system may have stopped the server meanwhile
  if (sent - state_->barrier.now > noticeable) await_from(state_->barrier, sent);
}

Outcome Server::collect(world::Commands& commands, const Wait& wait,
                        std::vector<world::Metric>* metrics) {
  const auto outcome =
      state_->wait_until([this] { return state_->barrier.gate.is_complete(); }, wait, &commands);
  if (outcome != Outcome::complete) return outcome;
  zero_missing(state_->barrier, commands);
  if (metrics != nullptr) *metrics = metrics_of_tick(state_->barrier);
  return outcome;
}

void Server::finish(const wire::End& end) { network::finish(state_->barrier, end); }

Outcome Server::drain(const Wait& wait) {
  return state_->wait_until([this] { return state_->barrier.sessions.size() == 0; }, wait, nullptr);
}

Outcome Server::linger(world::Commands& commands, const Wait& wait) {
  return state_->wait_until([] { return false; }, wait, &commands);
}

void Server::add_robots(std::span<const std::string> scripts,
                        const world::Observations& observations,
                        const std::vector<std::string>& tag_payloads) {
  state_->barrier.now = Clock::now();
  ++state_->changes;
  network::add_robots(state_->barrier, scripts, {&observations, &tag_payloads});
}

void Server::remove_robots(std::span<const std::size_t> robots, const std::string& why) {
  ++state_->changes;
  network::remove_robots(state_->barrier, robots, why);
}

void Server::set_paused(bool is_paused) {
  ++state_->changes;
  if (is_paused) return network::pause(state_->barrier);
  state_->advance(Clock::now());
  network::resume(state_->barrier);
}

Pause Server::pause() const {
  const TickGate& gate = state_->barrier.gate;
  if (gate.is_halted()) return Pause::halted;
  return gate.is_held(TickGate::Hold::paused) ? Pause::requested : Pause::none;
}

void keep_alive(Server& server) {
  Server::State& state = *server.state_;
  const Time now = Clock::now();
  keep_alive(state.barrier, now);
  if (state.link) state.link->release(now);
}

void Server::restart(const wire::Restart& restart) {
  // Only the time: until it is told, the barrier knows robots that the layout has no more.
  state_->barrier.now = Clock::now();
  ++state_->changes;
  if (state_->link) state_->link->set_seed(restart.seed);
  network::restart(state_->barrier, restart);
}

std::vector<Call> Server::take_calls() { return state_->barrier.calls.take(); }

bool Server::can_hear(const Call& call) const { return network::can_hear(state_->barrier, call); }

void Server::answer(const Call& call, const std::function<void(wire::Outbox&)>& write) {
  ++state_->changes;
  network::answer(state_->barrier, call, write);
}

void Server::answer_question(const Call& call, const std::function<void(wire::Outbox&)>& write) {
  const AnswerCache::Version version{state_->changes, state_->commands};
  wire::Answer& answer = state_->answers.find(call.request, version, write);
  network::answer(state_->barrier, call,
                  [&](wire::Outbox& outbox) { outbox.response(call.request.id, answer); });
}

void Server::fill(wire::Status& status) const {
  network::fill(state_->barrier, Clock::now(), status);
}

Need need_of(const Server& server, const std::vector<std::string>& ids) {
  return need_of(server.state_->barrier, ids);
}

std::vector<RobotStatus> Server::status() const { return robot_status(state_->barrier); }

Performance Server::performance() const {
  const Barrier& barrier = state_->barrier;
  Performance result{{}, barrier.reactions};
  const std::vector<std::uint64_t>& missed = barrier.deadlines.missed_ticks();
  for (std::size_t c = 0; c < missed.size(); ++c) {
    const Lost lost = state_->link ? state_->link->lost_messages()[c] : Lost{};
    result.controllers.push_back({missed[c], lost, barrier.answer_times[c]});
  }
  return result;
}

Report Server::take_report() {
  const Time now = Clock::now();
  Journal& journal = state_->barrier.journal;
  if (state_->link) {
    for (const std::string& notice : state_->link->take_notices()) journal.note(notice, now);
  }
  Report report = journal.take(now);
  std::ranges::move(state_->socket.take_notices(now), std::back_inserter(report.notices));
  return report;
}

void ServerDirectors::check_by(
    std::function<std::optional<wire::Fault>(const wire::Direction&)> check) {
  state_.barrier.directors.check = std::move(check);
}

const std::vector<Directed>& ServerDirectors::directions() const {
  return network::directions(state_.barrier);
}

bool ServerDirectors::wants_contacts() const { return network::wants_contacts(state_.barrier); }

bool ServerDirectors::has(const std::string& id) const {
  return state_.barrier.directors.find(id).has_value();
}

void ServerDirectors::warn(const std::string& director, wire::Fault fault) {
  warn_director(state_.barrier, director, std::move(fault));
}

std::vector<DirectorStatus> ServerDirectors::status() const {
  return director_status(state_.barrier);
}

}  // namespace ziggurat::network
