// SPDX-License-Identifier: MIT
// ROUTER/DEALER with the same order of work as our server: send to all peers, then receive all
// answers.

#include <unistd.h>
#include <zmq.h>

#include <array>
#include <stdexcept>

#include "lockstep/arena.h"

namespace ziggurat::bench {

struct Bare::State {
  void* context = zmq_ctx_new();
  void* router = zmq_socket(context, ZMQ_ROUTER);
  std::vector<std::string> peers;
  Bytes bytes;
  Processes processes;

  ~State() {
    const int linger = 0;
    zmq_setsockopt(router, ZMQ_LINGER, &linger, sizeof(linger));
    zmq_close(router);
    zmq_ctx_term(context);
  }

  /// Receives `count` messages. Appends the peer of each to `from`, if that is not null.
  void receive(std::size_t count, std::vector<std::string>* from) {
    zmq_msg_t frame;
    zmq_msg_init(&frame);
    while (count > 0) {
      if (zmq_msg_recv(&frame, router, ZMQ_DONTWAIT) < 0) {
        zmq_pollitem_t item{router, 0, ZMQ_POLLIN, 0};
        if (zmq_poll(&item, 1, 20'000) <= 0) throw std::runtime_error("bare: no message for 20 s");
        continue;
      }
      if (from != nullptr) {
        from->emplace_back(static_cast<const char*>(zmq_msg_data(&frame)), zmq_msg_size(&frame));
      }
      zmq_msg_recv(&frame, router, 0);
      --count;
    }
    zmq_msg_close(&frame);
  }
};

Bare::Bare(const Setup& setup, const Bytes& bytes) : state_(std::make_unique<State>()) {
  State& state = *state_;
  state.bytes = bytes;
  const std::string wanted = setup.transport == "ipc"
                                 ? "ipc://@ziggurat-bench-bare-" + std::to_string(::getpid())
                                 : "tcp://127.0.0.1:*";
  if (zmq_bind(state.router, wanted.c_str()) != 0) throw std::runtime_error("bare: can't bind");
  std::array<char, 256> endpoint{};
  std::size_t size = endpoint.size();
  zmq_getsockopt(state.router, ZMQ_LAST_ENDPOINT, endpoint.data(), &size);
  for (std::size_t i = 0; i < setup.processes; ++i) {
    state.processes.start(setup.client, {"bare", endpoint.data(), std::to_string(bytes.command)});
  }
  state.receive(setup.processes, &state.peers);
}

Bare::~Bare() = default;

void Bare::tick() {
  State& state = *state_;
  for (const std::string& peer : state.peers) {
    zmq_msg_t frame;
    zmq_msg_init_size(&frame, state.bytes.observation);
    zmq_send(state.router, peer.data(), peer.size(), ZMQ_SNDMORE);
    zmq_msg_send(&frame, state.router, 0);
  }
  state.receive(state.peers.size(), nullptr);
}

}  // namespace ziggurat::bench
