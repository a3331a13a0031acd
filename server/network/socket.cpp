#include "network/socket.h"

#include <fmt/format.h>

#include <cerrno>

namespace ziggurat::network {
namespace {

constexpr int linger_ms = 1000;       // what is under way at the end may take this long
constexpr int receive_queue = 64;     // messages of a peer that wait here; it waits beyond
constexpr int keepalive_idle_s = 30;  // tcp: answered by the peer's kernel, so that a controller
                                      // held in a debugger stays, and a vanished machine does not

std::string reason(const zmq::error_t& error) {
  switch (error.num()) {
    case EADDRINUSE:
      return "the address is taken; another server may listen there";
    case EADDRNOTAVAIL:
    case ENODEV:
      return "this machine has no such address";
    case EACCES:
      return "no permission to listen there";
    case ENOENT:
      return "the folder does not exist";
    default:
      return error.what();
  }
}

}  // namespace

Socket::Socket(const Config& config)
    : context_(config.io_threads), router_(context_, zmq::socket_type::router) {
  router_.set(zmq::sockopt::linger, linger_ms);
  router_.set(zmq::sockopt::router_mandatory, true);
  router_.set(zmq::sockopt::rcvhwm, receive_queue);
  router_.set(zmq::sockopt::tcp_keepalive, 1);
  router_.set(zmq::sockopt::tcp_keepalive_idle, keepalive_idle_s);
  // Twice what is allowed: up to there a peer is told TOO_LARGE, beyond it is disconnected.
  router_.set(zmq::sockopt::maxmsgsize, static_cast<std::int64_t>(2 * config.max_message_bytes));
  for (const std::string& endpoint : config.endpoints) bind(endpoint, config);
}

void Socket::bind(const std::string& endpoint, const Config& config) {
  check_endpoint(endpoint, config.insecure);
  std::string address = endpoint;
  constexpr std::string_view localhost = "tcp://localhost:";  // bind() takes addresses only
  if (address.starts_with(localhost)) {
    address = "tcp://127.0.0.1:" + address.substr(localhost.size());
  }
  router_.set(zmq::sockopt::ipv6, address.starts_with("tcp://["));
  try {
    router_.bind(address);
  } catch (const zmq::error_t& error) {
    throw EndpointError(fmt::format("{}: can't listen: {}", endpoint, reason(error)));
  }
  endpoints_.push_back(router_.get(zmq::sockopt::last_endpoint));
}

Delivery Socket::send(const std::string& peer, const wire::Outbox& message) {
  zmq::message_t frame(message.size());
  message.write(static_cast<std::uint8_t*>(frame.data()));
  try {
    const auto flags = zmq::send_flags::sndmore | zmq::send_flags::dontwait;
    if (!router_.send(zmq::const_buffer(peer.data(), peer.size()), flags)) {
      return Delivery::congested;
    }
    return router_.send(frame, zmq::send_flags::dontwait) ? Delivery::sent : Delivery::congested;
  } catch (const zmq::error_t& error) {
    if (error.num() == EHOSTUNREACH) return Delivery::unreachable;
    throw;
  }
}

bool Socket::receive(Received& received) {
  if (!router_.recv(frame_, zmq::recv_flags::dontwait)) return false;
  received.peer.assign(static_cast<const char*>(frame_.data()), frame_.size());
  int frames = 0;
  while (frame_.more()) {
    (void)router_.recv(frame_, zmq::recv_flags::none);
    ++frames;
  }
  received.is_single_frame = frames == 1;
  received.bytes = {static_cast<const char*>(frame_.data()), frame_.size()};
  return true;
}

Socket::Ready Socket::poll(const Wait& wait) {
  items_.clear();
  items_.push_back({router_.handle(), 0, ZMQ_POLLIN, 0});
  for (const int descriptor : wait.descriptors)
    items_.push_back({nullptr, descriptor, ZMQ_POLLIN, 0});
  const int count = zmq_poll(items_.data(), static_cast<int>(items_.size()), wait.timeout.count());
  if (count < 0 && zmq_errno() != EINTR) throw zmq::error_t();
  if (count < 0) return Ready::woken;
  for (std::size_t i = 1; i < items_.size(); ++i) {
    if (items_[i].revents != 0) return Ready::woken;
  }
  return count > 0 ? Ready::message : Ready::timed_out;
}

}  // namespace ziggurat::network
