#include "network/socket.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>

#include "network/endpoint.h"

namespace ziggurat::network {
namespace {

constexpr int linger_ms = 1000;            // what is under way at the end may take this long
constexpr int receive_queue = 8;           // messages of a peer that wait here; it waits beyond
constexpr int waiting_connections = 4096;  // until they are accepted; beyond the queue's end the
                                           // kernel lets them try again, after seconds
constexpr int handshake_ms = 10000;        // half-open connections hold a descriptor no longer
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

Socket::Socket(const Config& config) : context_(config.io_threads) {
  if (config.curve) {
    clients_ = config.curve->clients;
    gatekeeper_.emplace(context_, clients_);
  }
  try {
    routers_.push_back(make_router(config));
    if (config.curve) {
      routers_[0].set(zmq::sockopt::curve_server, true);
      routers_[0].set(zmq::sockopt::curve_secretkey, config.curve->secret_key);
    }
    const bool allows_any = config.insecure || config.curve;
    for (const std::string& endpoint : config.endpoints) bind(routers_[0], endpoint, allows_any);
  } catch (...) {
    close();
    throw;
  }
}

Socket::~Socket() { close(); }

/// Ends the gatekeeper, too.
void Socket::close() {
  // While it listens, no other server takes a path.
  for (const std::string& file : files_) ::unlink(file.c_str());
  routers_.clear();
  if (gatekeeper_) context_.shutdown();
}

void Socket::add_private(const Config& config) {
  routers_.push_back(make_router(config));
  bind(routers_.back(), config.private_endpoint, false);
  std::rotate(endpoints_.begin(), endpoints_.end() - 1, endpoints_.end());
}

zmq::socket_t Socket::make_router(const Config& config) {
  zmq::socket_t router(context_, zmq::socket_type::router);
  router.set(zmq::sockopt::linger, linger_ms);
  router.set(zmq::sockopt::router_mandatory, true);
  router.set(zmq::sockopt::rcvhwm, receive_queue);
  router.set(zmq::sockopt::backlog, waiting_connections);
  router.set(zmq::sockopt::handshake_ivl, handshake_ms);
  router.set(zmq::sockopt::tcp_keepalive, 1);
  router.set(zmq::sockopt::tcp_keepalive_idle, keepalive_idle_s);
  // Twice what is allowed: up to there a peer is told TOO_LARGE, beyond it is disconnected.
  router.set(zmq::sockopt::maxmsgsize, static_cast<std::int64_t>(2 * config.max_message_bytes));
  return router;
}

void Socket::bind(zmq::socket_t& router, const std::string& endpoint, bool allows_any) {
  check_endpoint(endpoint, allows_any);
  std::string address = endpoint;
  constexpr std::string_view localhost = "tcp://localhost:";  // bind() takes addresses only
  if (address.starts_with(localhost)) {
    address = "tcp://127.0.0.1:" + address.substr(localhost.size());
  }
  router.set(zmq::sockopt::ipv6, address.starts_with("tcp://["));
  try {
    router.bind(address);
  } catch (const zmq::error_t& error) {
    throw EndpointError(fmt::format("{}: can't listen: {}", endpoint, reason(error)));
  }
  endpoints_.push_back(router.get(zmq::sockopt::last_endpoint));
  if (std::string file = file_of(endpoint); !file.empty()) files_.push_back(std::move(file));
}

Delivery Socket::send(const std::string& connection, const wire::Outbox& message) {
  zmq::message_t frame(message.size());
  message.write(static_cast<std::uint8_t*>(frame.data()));
  return send_frame(connection, frame);
}

Delivery Socket::send(const std::string& connection, std::string_view bytes) {
  zmq::message_t frame(bytes);
  return send_frame(connection, frame);
}

Delivery Socket::send_frame(const std::string& connection, zmq::message_t& frame) {
  zmq::socket_t& router = routers_[static_cast<std::size_t>(connection[0])];
  try {
    const auto flags = zmq::send_flags::sndmore | zmq::send_flags::dontwait;
    const zmq::const_buffer id(connection.data() + 1, connection.size() - 1);
    if (!router.send(id, flags)) return Delivery::congested;
    return router.send(frame, zmq::send_flags::dontwait) ? Delivery::sent : Delivery::congested;
  } catch (const zmq::error_t& error) {
    if (error.num() == EHOSTUNREACH) return Delivery::unreachable;
    throw;
  }
}

bool Socket::receive(Received& received) {
  for (std::size_t i = 0; i < routers_.size(); ++i) {
    const std::size_t router = next_;
    next_ = (next_ + 1) % routers_.size();
    if (receive(static_cast<char>(router), received)) return true;
  }
  return false;
}

bool Socket::receive(char index, Received& received) {
  zmq::socket_t& router = routers_[static_cast<std::size_t>(index)];
  if (!router.recv(frame_, zmq::recv_flags::dontwait)) return false;
  received.connection.assign(1, index);
  received.connection.append(static_cast<const char*>(frame_.data()), frame_.size());
  int frames = 0;
  while (frame_.more()) {
    (void)router.recv(frame_, zmq::recv_flags::none);
    ++frames;
  }
  received.is_single_frame = frames == 1;
  received.bytes = {static_cast<const char*>(frame_.data()), frame_.size()};
  received.roles = index == 0 && gatekeeper_ ? roles_of_sender() : all_roles;
  return true;
}

/// What the key of the connection allows; nothing if it has none.
Roles Socket::roles_of_sender() {
  const char* user = zmq_msg_gets(frame_.handle(), "User-Id");
  const std::string_view text = user == nullptr ? "" : user;
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  const bool is_number = error == std::errc{} && end == text.data() + text.size();
  return is_number && index < clients_.size() ? clients_[index].roles : Roles{};
}

Socket::Ready Socket::poll(std::chrono::milliseconds timeout, std::span<const int> descriptors) {
  items_.clear();
  for (auto& router : routers_) items_.push_back({router.handle(), 0, ZMQ_POLLIN, 0});
  for (const int descriptor : descriptors) {
    items_.push_back({nullptr, descriptor, ZMQ_POLLIN, 0});
  }
  const int count = zmq_poll(items_.data(), static_cast<int>(items_.size()), timeout.count());
  if (count < 0 && zmq_errno() != EINTR) throw zmq::error_t();
  if (count < 0) return Ready::woken;
  for (std::size_t i = routers_.size(); i < items_.size(); ++i) {
    if (items_[i].revents != 0) return Ready::woken;
  }
  return count > 0 ? Ready::message : Ready::timed_out;
}

}  // namespace ziggurat::network
