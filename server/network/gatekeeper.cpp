#include "network/gatekeeper.h"

#include <signal.h>

#include <array>
#include <vector>

namespace ziggurat::network {

Gatekeeper::Gatekeeper(zmq::context_t& context, std::span<const ClientKey> clients)
    : socket_(context, zmq::socket_type::rep) {
  for (std::size_t i = 0; i < clients.size(); ++i) {
    std::array<std::uint8_t, 32> key;
    zmq_z85_decode(key.data(), clients[i].public_key.c_str());
    clients_.emplace(std::string(key.begin(), key.end()), i);
  }
  socket_.set(zmq::sockopt::linger, 0);
  socket_.bind("inproc://zeromq.zap.01");
  // Signals are for the main thread: the new one gets none.
  sigset_t all, before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([this] { serve(); });
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

Gatekeeper::~Gatekeeper() { thread_.join(); }

void Gatekeeper::serve() {
  try {
    for (;;) answer();
  } catch (const zmq::error_t&) {  // the context is shut down
  }
  socket_.close();
}

void Gatekeeper::answer() {
  // version, request id, domain, address, routing id, mechanism, credentials
  std::vector<std::string> request;
  zmq::message_t frame;
  do {
    if (!socket_.recv(frame)) return;
    request.push_back(frame.to_string());
  } while (frame.more());
  const bool is_curve = request.size() == 7 && request[0] == "1.0" && request[5] == "CURVE";
  const auto found = is_curve ? clients_.find(request[6]) : clients_.end();
  const bool is_known = found != clients_.end();
  const std::array<std::string, 6> reply{"1.0",
                                         request.size() > 1 ? request[1] : "",
                                         is_known ? "200" : "400",
                                         is_known ? "welcome" : "this key is not on the list",
                                         is_known ? std::to_string(found->second) : "",
                                         ""};
  for (std::size_t i = 0; i < reply.size(); ++i) {
    const bool is_last = i + 1 == reply.size();
    socket_.send(zmq::buffer(reply[i]), is_last ? zmq::send_flags::none : zmq::send_flags::sndmore);
  }
}

}  // namespace ziggurat::network
