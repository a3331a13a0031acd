#include "network/server.h"

#include <algorithm>

#include "network/barrier.h"
#include "network/socket.h"

namespace ziggurat::network {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

// While nothing comes, connections are probed after this long, then ever more rarely: a peer that
// is held in a debugger for a night must not find a thousand heartbeats in its queue.
constexpr milliseconds first_probe{1'000};
constexpr milliseconds last_probe{60'000};

// Between looks at descriptors and the time, so that no flood keeps us from either.
constexpr int messages_at_once = 1000;

}  // namespace

struct Server::State {
  State(const Config& config, const wire::Run& run)
      : socket(config), barrier(config, run, [this](const std::string& peer, const auto& message) {
          return socket.send(peer, message);
        }) {}

  template <class Done>
  Outcome wait_until(Done done, const Wait& wait, world::Commands* commands);
  template <class Done>
  bool receive(Done done, world::Commands* commands);

  Socket socket;
  Barrier barrier;
  Socket::Received received;
  milliseconds pause = first_probe;  // until the next probe
  Clock::time_point probe = Clock::now() + first_probe;
};

Server::Server(const Config& config, const wire::Run& run)
    : state_(std::make_unique<State>(config, run)) {}
Server::~Server() = default;

/// Takes messages as they are there until `done` or there is none. True if done.
template <class Done>
bool Server::State::receive(Done done, world::Commands* commands) {
  for (int i = 0; i < messages_at_once && socket.receive(received); ++i) {
    if (received.is_single_frame) {
      barrier.receive(received.peer, received.bytes, commands);
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
    if (receive(done, commands)) return Outcome::complete;
    const auto wake = is_bounded ? std::min(end, probe) : probe;
    const auto rest = std::chrono::ceil<milliseconds>(wake - Clock::now());
    const auto ready = socket.poll({std::max(rest, milliseconds{0}), wait.descriptors});
    if (ready == Socket::Ready::woken) return Outcome::woken;
    const auto now = Clock::now();
    if (now >= probe) {
      barrier.probe();
      pause = std::min(2 * pause, last_probe);
      probe = now + pause;
    }
    if (is_bounded && now >= end) {
      return receive(done, commands) ? Outcome::complete : Outcome::timed_out;
    }
  }
}

const std::vector<std::string>& Server::endpoints() const { return state_->socket.endpoints(); }

Outcome Server::gather(const Wait& wait) {
  return state_->wait_until([this] { return state_->barrier.gathered(); }, wait, nullptr);
}

void Server::publish(const world::Observations& observations,
                     std::span<const std::string> tag_payloads) {
  state_->barrier.publish(observations, tag_payloads);
  state_->pause = first_probe;
  state_->probe = Clock::now() + first_probe;
}

Outcome Server::collect(world::Commands& commands, const Wait& wait) {
  const auto outcome =
      state_->wait_until([this] { return state_->barrier.complete(); }, wait, &commands);
  if (outcome == Outcome::complete) state_->barrier.zero_gone(commands);
  return outcome;
}

void Server::finish(const wire::End& end) {
  state_->barrier.finish(end);
  state_->pause = first_probe;
  state_->probe = Clock::now() + first_probe;
}

Outcome Server::drain(const Wait& wait) {
  return state_->wait_until([this] { return state_->barrier.drained(); }, wait, nullptr);
}

void Server::remove_robots(std::span<const std::size_t> robots) {
  state_->barrier.remove_robots(robots);
}

std::vector<RobotStatus> Server::status() const { return state_->barrier.status(); }

Report Server::take_report() { return state_->barrier.take_report(); }

}  // namespace ziggurat::network
