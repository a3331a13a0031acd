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

constexpr milliseconds slice{500};  // between looks at whether the connection still stands
constexpr int linger_ms = 1000;     // for the last words, if the server is there
constexpr const char* monitor_address = "inproc://monitor";

void set_option(void* socket, int option, int value) {
  zmq_setsockopt(socket, option, &value, sizeof(value));
}

}  // namespace

Connection::Connection(const Options& options)
    : endpoint_(options.endpoint),
      context_(zmq_ctx_new()),
      socket_(zmq_socket(context_, ZMQ_DEALER)) {
  zmq_msg_init(&frame_);
  set_option(socket_, ZMQ_IPV6, endpoint_.find('[') == std::string::npos ? 0 : 1);
  set_option(socket_, ZMQ_TCP_KEEPALIVE, 1);
  set_option(socket_, ZMQ_LINGER, 0);
  zmq_socket_monitor(socket_, monitor_address, ZMQ_EVENT_DISCONNECTED);
  monitor_ = zmq_socket(context_, ZMQ_PAIR);
  set_option(monitor_, ZMQ_LINGER, 0);
  zmq_connect(monitor_, monitor_address);
  try {
    set_keys(options);
  } catch (const std::invalid_argument&) {
    close();
    throw;
  }
  if (zmq_connect(socket_, endpoint_.c_str()) == 0) return;
  const std::string reason = zmq_strerror(zmq_errno());
  close();
  throw std::invalid_argument("'" + endpoint_ + "': not an endpoint to connect to (" + reason +
                              "); ipc:///path or tcp://host:port would do");
}

/// Encrypts the connection, if the options name keys.
void Connection::set_keys(const Options& options) {
  if (options.server_key.empty() && options.curve_secret.empty()) return;
  if (options.server_key.empty() || options.curve_secret.empty()) {
    throw std::invalid_argument(
        "the server's public key and a file with a secret key belong together; one is missing");
  }
  std::ifstream file(options.curve_secret);
  std::string secret;
  std::array<char, 41> own;
  if (!(file >> secret) || zmq_curve_public(own.data(), secret.c_str()) != 0) {
    throw std::invalid_argument("'" + options.curve_secret +
                                "': not a file with a secret key; 'ziggurat keygen' makes one");
  }
  const auto set = [&](int option, const std::string& key) {
    return zmq_setsockopt(socket_, option, key.c_str(), key.size() + 1) == 0;
  };
  if (options.server_key.size() != 40 || !set(ZMQ_CURVE_SERVERKEY, options.server_key)) {
    throw std::invalid_argument("'" + options.server_key +
                                "': not a public key of 40 characters, as 'ziggurat keygen' "
                                "prints it");
  }
  set(ZMQ_CURVE_PUBLICKEY, own.data());
  set(ZMQ_CURVE_SECRETKEY, secret);
}

Connection::~Connection() { close(); }

void Connection::close() {
  if (is_expected_open_ && !is_closed_) set_option(socket_, ZMQ_LINGER, linger_ms);
  zmq_msg_close(&frame_);
  zmq_socket_monitor(socket_, nullptr, 0);
  zmq_close(monitor_);
  zmq_close(socket_);
  zmq_ctx_term(context_);
}

void Connection::send(const v1::ClientMessage& message) {
  zmq_msg_t frame;
  zmq_msg_init_size(&frame, message.ByteSizeLong());
  message.SerializeWithCachedSizesToArray(static_cast<std::uint8_t*>(zmq_msg_data(&frame)));
  while (zmq_msg_send(&frame, socket_, 0) < 0) {
    if (zmq_errno() == EINTR) continue;
    zmq_msg_close(&frame);
    throw ConnectionError(endpoint_ + ": can't send: " + zmq_strerror(zmq_errno()));
  }
}

std::optional<Connection::Kind> Connection::receive(std::optional<milliseconds> timeout,
                                                    const std::function<bool()>& is_interrupted) {
  const auto end = Clock::now() + timeout.value_or(milliseconds{0});
  milliseconds rest = timeout.value_or(slice);
  for (;;) {
    if (receive_frame(std::clamp(rest, milliseconds{0}, slice))) return parse();
    if (was_closed()) {
      // What was sent before the end may still be in the queue.
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
    set_option(socket_, ZMQ_RCVTIMEO, static_cast<int>(timeout.count()));
    socket_timeout_ = timeout;
  }
  if (zmq_msg_recv(&frame_, socket_, 0) >= 0) return true;
  if (zmq_errno() == EAGAIN || zmq_errno() == EINTR) return false;
  throw ConnectionError(endpoint_ + ": can't receive: " + zmq_strerror(zmq_errno()));
}

bool Connection::was_closed() {
  zmq_msg_t event;
  zmq_msg_init(&event);
  while (zmq_msg_recv(&event, monitor_, ZMQ_DONTWAIT) >= 0) {
    std::uint16_t number = 0;
    if (zmq_msg_size(&event) >= sizeof(number)) {
      std::memcpy(&number, zmq_msg_data(&event), sizeof(number));
    }
    while (zmq_msg_more(&event) != 0) zmq_msg_recv(&event, monitor_, 0);  // the address
    if (number == ZMQ_EVENT_DISCONNECTED && is_expected_open_) is_closed_ = true;
  }
  zmq_msg_close(&event);
  return is_closed_;
}

}  // namespace ziggurat
