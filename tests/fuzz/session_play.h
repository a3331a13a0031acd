// SPDX-License-Identifier: MIT
#pragma once
// A barrier and its peers, played from the bytes of an input.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "network/barrier/admission.h"
#include "network/barrier/departure.h"
#include "network/barrier/dispatch.h"
#include "network/barrier/exchange.h"
#include "network/barrier/overview.h"
#include "network/barrier/population.h"
#include "network/barrier/timeouts.h"
#include "network/small_run.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::fuzz {

using namespace network;
using std::chrono::milliseconds;

constexpr std::size_t robots = 4;
constexpr std::size_t seats = 5;  // peers at a time
constexpr std::size_t most_controllers = 3, most_supervisors = 1;
constexpr std::size_t most_sessions = most_controllers + most_supervisors;

struct Input {
  const std::uint8_t* data;
  std::size_t size;
  bool empty() const { return size == 0; }
  std::uint8_t byte() {
    if (size == 0) return 0;
    --size;
    return *data++;
  }
  std::size_t below(std::size_t limit) { return byte() % limit; }
};

/// Messages that a connection has been sent.
struct Told {
  bool welcomed = false;  ///< and nothing since that ends a session
  bool waiting = false;   ///< was told that the world is loading
  bool draining = false;  ///< was told the end
  bool has_tick = false;
  std::uint64_t tick = 0;
  std::string token;
  std::uint64_t robots = 0;
  Delivery delivery = Delivery::sent;  ///< what becomes of messages to it
  bool may_be_lost = false;            ///< a message did not reach it
};

inline Config make_config(Input& input) {
  Config config;
  config.max_sessions = most_controllers;
  config.max_supervisors = most_supervisors;
  config.max_observers = config.max_directors = 0;
  config.max_faults = 3;
  config.rate = {20, 12};
  const std::uint8_t bits = input.byte();
  config.lease = milliseconds{bits % 2 == 0 ? 0 : 700};
  config.deadlines.resize(bits / 2 % 3);
  for (Config::Deadline& deadline : config.deadlines) {
    deadline.policy.action = static_cast<scene::DeadlineAction>(1 + input.below(5));
    if (deadline.policy.action != scene::DeadlineAction::wait) {
      deadline.policy = {deadline.policy.action, 100, static_cast<std::uint32_t>(input.below(3))};
    }
    deadline.is_fixed = bits >= 128;
  }
  return config;
}

class Play {
 public:
  Play(const SmallRun& small, Input input)
      : small_(small),
        input_(input),
        commands_(small.commands()),
        config_(make_config(input_)),
        barrier_(
            config_,
            [this](const std::string& peer, const wire::Outbox& message) {
              return hear(peer, message);
            },
            now_) {
    for (std::size_t i = 0; i < seats; ++i) connect(i);
  }

  /// An even first byte begins while the world is loading.
  void run() {
    if (input_.byte() % 2 == 1) open();
    while (!input_.empty()) {
      step();
      check();
    }
  }

 private:
  enum class Phase { loading, gathering, collecting, between, over };

  void connect(std::size_t seat) {
    ids_[seat] = {static_cast<char>('a' + seat), static_cast<char>(++connections_ % 256),
                  static_cast<char>(connections_ / 256)};
    told_[ids_[seat]];
  }
  const std::string& peer() { return ids_[input_.below(seats)]; }

  Delivery hear(const std::string& peer, const wire::Outbox& outbox);
  void hear_tick(Told& told, const v1::Observation& observation) const;
  void say(const std::string& peer, const v1::ClientMessage& message);
  void receive(const std::string& peer, std::string_view bytes, bool is_single_frame = true);
  void send_hello();
  void send_command(const std::string& peer);
  void send_leave();
  void send_request();
  void send_anything();
  void answer_all();
  void open();
  void pass();
  void move_on();
  void change_connection();
  void supervise();
  void step();
  void check();
  void check_robots(const wire::Status& status) const;
  void check_deadlines(const wire::Status& status);

  const SmallRun& small_;
  Input input_;
  std::array<std::string, seats> ids_;
  std::map<std::string, Told> told_;
  unsigned connections_ = 0;
  Time now_{};
  world::Commands commands_;
  Phase phase_ = Phase::loading;
  std::uint64_t tick_ = 0;  // published
  bool is_paused_ = false, is_stopped_ = false;
  bool has_looked_ = false;  // at deadlines, and nothing has happened since
  v1::ServerMessage heard_;
  std::vector<std::uint8_t> bytes_;
  world::Observations observations_;  // of the published tick
  const std::vector<std::string> payloads_;
  Config config_;
  Barrier barrier_;
};

}  // namespace ziggurat::fuzz
