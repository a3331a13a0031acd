#include "network/server.h"

#include <algorithm>

#include "network/barrier.h"
#include "network/reception.h"
#include "network/socket.h"

namespace ziggurat::network {
namespace {

using std::chrono::milliseconds;

// Between looks at descriptors and the time, so that no flood keeps us from either.
constexpr int messages_at_once = 1000;

}  // namespace

struct Server::State {
  State(const Config& config, const wire::Run& run, std::unique_ptr<Socket> listening)
      : socket(std::move(listening)),
        barrier(
            config, run,
            [this](const std::string& peer, const auto& message) {
              return socket->send(peer, message);
            },
            Clock::now()) {}

  template <class Done>
  Outcome wait_until(Done done, const Wait& wait, world::Commands* commands);
  template <class Done>
  bool receive(Done done, world::Commands* commands);

  std::unique_ptr<Socket> socket;
  std::vector<Reception::Visitor> visitors;  // whose Hello is still to be handled
  Barrier barrier;
  Socket::Received received;
};

Server::Server(const Config& config, const wire::Run& run)
    : state_(std::make_unique<State>(config, run, std::make_unique<Socket>(config))) {}

Server::Server(const Config& config, const wire::Run& run, Reception& reception) {
  auto [socket, visitors] = reception.hand_over();
  if (!config.private_endpoint.empty()) socket->add_private(config);
  state_ = std::make_unique<State>(config, run, std::move(socket));
  state_->visitors = std::move(visitors);
}

Server::~Server() = default;

/// Takes messages as they are there until `done` or there is none. True if done.
template <class Done>
bool Server::State::receive(Done done, world::Commands* commands) {
  for (const auto& visitor : std::exchange(visitors, {})) {
    barrier.receive(visitor.peer, visitor.hello, commands, visitor.roles);
  }
  barrier.receive_due(commands);
  for (int i = 0; i < messages_at_once && socket->receive(received); ++i) {
    if (received.is_single_frame) {
      barrier.receive(received.peer, received.bytes, commands, received.roles);
    } else {
      barrier.receive_malformed(received.peer);
    }
    if (done()) return true;
  }
  return done();
}

template <class Done>
Outcome Server::State::wait_until(Done done, const Wait& wait, world::Commands* commands) {
  const bool is_bounded = wait.timeout.count() >= 0;
  const auto end = Clock::now() + (is_bounded ? wait.timeout : milliseconds{0});
  for (;;) {
    // What has arrived is not late, however long we were kept from looking.
    barrier.tell_time(Clock::now());
    if (receive(done, commands)) return Outcome::complete;
    barrier.advance(Clock::now());
    if (done()) return Outcome::complete;
    if (barrier.has_news()) return Outcome::woken;
    const auto wake = is_bounded ? std::min(end, barrier.due()) : barrier.due();
    const auto rest = std::chrono::ceil<milliseconds>(wake - Clock::now());
    const auto ready = socket->poll({std::max(rest, milliseconds{0}), wait.descriptors});
    if (ready == Socket::Ready::woken) return Outcome::woken;
    if (is_bounded && Clock::now() >= end) {
      barrier.tell_time(Clock::now());
      return receive(done, commands) ? Outcome::complete : Outcome::timed_out;
    }
  }
}

const std::vector<std::string>& Server::endpoints() const { return state_->socket->endpoints(); }

Outcome Server::gather(const Wait& wait) {
  return state_->wait_until([this] { return state_->barrier.gathered(); }, wait, nullptr);
}

void Server::publish(const world::Observations& observations,
                     std::span<const std::string> tag_payloads) {
  state_->barrier.advance(Clock::now());
  state_->barrier.publish(observations, tag_payloads);
}

Outcome Server::collect(world::Commands& commands, const Wait& wait) {
  const auto outcome =
      state_->wait_until([this] { return state_->barrier.complete(); }, wait, &commands);
  if (outcome == Outcome::complete) state_->barrier.zero_missing(commands);
  return outcome;
}

void Server::finish(const wire::End& end) { state_->barrier.finish(end); }

Outcome Server::drain(const Wait& wait) {
  return state_->wait_until([this] { return state_->barrier.drained(); }, wait, nullptr);
}

Outcome Server::linger(world::Commands& commands, const Wait& wait) {
  return state_->wait_until([] { return false; }, wait, &commands);
}

void Server::add_robots(std::span<const std::string> scripts,
                        const world::Observations& observations,
                        std::span<const std::string> tag_payloads) {
  state_->barrier.advance(Clock::now());
  state_->barrier.add_robots(scripts, observations, tag_payloads);
}

void Server::remove_robots(std::span<const std::size_t> robots, const std::string& why) {
  state_->barrier.remove_robots(robots, why);
}

void Server::pause() { state_->barrier.pause(); }

void Server::resume() {
  state_->barrier.advance(Clock::now());
  state_->barrier.resume();
}

bool Server::paused() const { return state_->barrier.standing(); }

std::vector<std::uint64_t> Server::missed_ticks() const { return state_->barrier.missed_ticks(); }

void Server::reset(std::uint64_t seed) {
  state_->barrier.advance(Clock::now());
  state_->barrier.reset(seed);
}

std::vector<Call> Server::take_calls() { return state_->barrier.take_calls(); }

bool Server::can_hear(const Call& call) const { return state_->barrier.can_hear(call); }

void Server::answer(const Call& call, const std::function<void(wire::Outbox&)>& write) {
  state_->barrier.answer(call, write);
}

void Server::fill(wire::Status& status) const { state_->barrier.fill(status); }

const std::vector<Latencies>& Server::latencies() const { return state_->barrier.latencies(); }

const std::vector<Lost>& Server::lost_messages() const { return state_->barrier.lost_messages(); }

std::vector<RobotStatus> Server::status() const { return state_->barrier.status(); }

Report Server::take_report() { return state_->barrier.take_report(); }

}  // namespace ziggurat::network
