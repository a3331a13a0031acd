#include "connection.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "ziggurat/error.h"

namespace ziggurat {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr milliseconds slice{500};    // between checks of whether the connection is open
constexpr milliseconds linger{1000};  // time to send the last messages
constexpr const char* monitor_address = "inproc://monitor";

/// False if there is none yet, or a signal arrived.
bool receive(zmq::socket_t& socket, zmq::message_t& message, zmq::recv_flags flags) {
  try {
    return socket.recv(message, flags).has_value();
  } catch (const zmq::error_t& error) {
    if (error.num() == EINTR) return false;
    throw;
  }
}

}  // namespace

Connection::Connection(const Options& options)
    : endpoint_(options.endpoint),
      socket_(context_, zmq::socket_type::dealer),
      monitor_(context_, zmq::socket_type::pair) {
  socket_.set(zmq::sockopt::ipv6, endpoint_.find('[') != std::string::npos);
  socket_.set(zmq::sockopt::tcp_keepalive, 1);
  socket_.set(zmq::sockopt::linger, 0);
  monitor_.set(zmq::sockopt::linger, 0);
  zmq_socket_monitor(socket_.handle(), monitor_address, ZMQ_EVENT_DISCONNECTED);
  monitor_.connect(monitor_address);
  set_keys(options);
  try {
    socket_.connect(endpoint_);
  } catch (const zmq::error_t& error) {
    throw std::invalid_argument("'" + endpoint_ + "': not an endpoint to connect to (" +
                                error.what() + "); write ipc:///path or tcp://host:port");
  }
}

/// Encrypts the connection, if the options name keys.
void Connection::set_keys(const Options& options) {
  if (options.server_key.empty() && options.curve_secret.empty()) return;
  if (options.server_key.empty() || options.curve_secret.empty()) {
    throw std::invalid_argument(
        "only one of server_key and curve_secret is set; an encrypted connection needs both");
  }
  std::ifstream file(options.curve_secret);
  std::string secret;
  std::array<char, 41> own;
  if (!(file >> secret) || zmq_curve_public(own.data(), secret.c_str()) != 0) {
    throw std::invalid_argument(
        "'" + options.curve_secret +
        "': not a file with a secret key; create one with 'ziggurat keygen'");
  }
  try {
    if (options.server_key.size() != 40) throw zmq::error_t(EINVAL);
    socket_.set(zmq::sockopt::curve_serverkey, options.server_key);
  } catch (const zmq::error_t&) {
    throw std::invalid_argument("'" + options.server_key +
                                "': not a public key; it has 40 characters and is printed by "
                                "'ziggurat keygen'");
  }
  socket_.set(zmq::sockopt::curve_publickey, own.data());
  socket_.set(zmq::sockopt::curve_secretkey, secret);
}

Connection::~Connection() {
  if (!is_expected_open_ || is_closed_) return;
  try {
    socket_.set(zmq::sockopt::linger, static_cast<int>(linger.count()));
  } catch (const zmq::error_t&) {
    // The last messages may be lost; there is nothing else to do.
  }
}

void Connection::send(const v1::ClientMessage& message) {
  zmq::message_t frame(message.ByteSizeLong());
  message.SerializeWithCachedSizesToArray(frame.data<std::uint8_t>());
  for (;;) {
    try {
      socket_.send(frame, zmq::send_flags::none);
      return;
    } catch (const zmq::error_t& error) {
      if (error.num() == EINTR) continue;
      throw ConnectionError(endpoint_ + ": can't send: " + error.what());
    }
  }
}

std::optional<Connection::Kind> Connection::receive(std::optional<milliseconds> timeout,
                                                    const std::function<bool()>& is_interrupted) {
  const auto end = Clock::now() + timeout.value_or(milliseconds{0});
  milliseconds rest = timeout.value_or(slice);
  for (;;) {
    if (receive_frame(std::clamp(rest, milliseconds{0}, slice))) return parse();
    if (was_closed()) {
      // Messages that the server sent before may still be in the queue.
      if (receive_frame(milliseconds{0})) return parse();
      throw ConnectionError(endpoint_ + ": the server closed the connection");
    }
    if (is_interrupted && is_interrupted()) return std::nullopt;
    if (!timeout) continue;
    rest = std::chrono::ceil<milliseconds>(end - Clock::now());
    if (rest.count() <= 0) return std::nullopt;
  }
}

bool Connection::receive_frame(milliseconds timeout) {
  if (timeout != socket_timeout_) {
    socket_.set(zmq::sockopt::rcvtimeo, static_cast<int>(timeout.count()));
    socket_timeout_ = timeout;
  }
  try {
    return ziggurat::receive(socket_, frame_, zmq::recv_flags::none);
  } catch (const zmq::error_t& error) {
    throw ConnectionError(endpoint_ + ": can't receive: " + error.what());
  }
}

bool Connection::was_closed() {
  zmq::message_t event;
  while (ziggurat::receive(monitor_, event, zmq::recv_flags::dontwait)) {
    std::uint16_t number = 0;
    if (event.size() >= sizeof(number)) std::memcpy(&number, event.data(), sizeof(number));
    while (event.more()) ziggurat::receive(monitor_, event, zmq::recv_flags::none);  // the address
    if (number == ZMQ_EVENT_DISCONNECTED && is_expected_open_) is_closed_ = true;
  }
  return is_closed_;
}

}  // namespace ziggurat
