// SPDX-License-Identifier: MIT
#include "transport.h"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <tuple>
#include <zmq.hpp>

#include "endpoint.h"
#include "ziggurat/error.h"

namespace ziggurat {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds longest_wait_to_send{
    500};  // between checks of whether the connection was refused
constexpr milliseconds longest_linger{1000};  // when a connection ends, with output that waits
constexpr const char* keys_are_missing =
    "refused key? The endpoint is protected, and this client has no keys; set the server's public "
    "key "
    "and a secret key";
constexpr const char* monitor_address = "inproc://monitor";
constexpr int monitored = ZMQ_EVENT_CONNECTED | ZMQ_EVENT_DISCONNECTED |
                          ZMQ_EVENT_HANDSHAKE_SUCCEEDED | ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL |
                          ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL | ZMQ_EVENT_HANDSHAKE_FAILED_AUTH;
// A server that ends, or has no place, also breaks a handshake off: ZeroMQ tries again.
constexpr unsigned most_failed_handshakes = 3;

/// False if there is none yet, or a signal arrived.
bool receive_from(zmq::socket_t& socket, zmq::message_t& message, zmq::recv_flags flags) {
  try {
    return socket.recv(message, flags).has_value();
  } catch (const zmq::error_t& error) {
    if (error.num() == EINTR) return false;
    throw;
  }
}

/// A DEALER of libzmq, and the monitor that reports what becomes of its connection.
class ZeroMq final : public Transport {
 public:
  explicit ZeroMq(const SessionOptions& options);
  ~ZeroMq() override;
  ZeroMq(const ZeroMq&) = delete;
  ZeroMq& operator=(const ZeroMq&) = delete;

  void send(std::size_t size, const std::function<void(char*)>& write) override;
  bool receive(milliseconds timeout) override;
  std::string_view content() override { return frame_.to_string_view(); }
  bool has_more() const override { return frame_.more(); }
  bool was_closed() override;
  bool is_accepted() override;
  void linger() override;

 private:
  /// Whether the program was forked since: threads of libzmq are the parent's, and calls would wait
  /// for them.
  bool is_parents() const { return ::getpid() != process_; }
  void set_keys(const SessionOptions& options);
  bool take_events();
  void take_event(std::uint16_t event, std::uint32_t value);

  pid_t process_ = ::getpid();
  std::string endpoint_;
  zmq::context_t context_;
  zmq::socket_t socket_;
  zmq::socket_t monitor_;
  bool is_accepted_ = false;
  bool is_open_ = false;  // the handshake has succeeded
  bool is_closed_ = false;
  bool has_keys_ = false;
  unsigned failed_handshakes_ = 0;  // without a reason
  std::string refusal_;             // of the handshake; empty: none
  zmq::message_t frame_;
  int socket_fd_ = socket_.get(zmq::sockopt::fd), monitor_fd_ = monitor_.get(zmq::sockopt::fd);
};

ZeroMq::ZeroMq(const SessionOptions& options)
    : endpoint_(options.endpoint),
      socket_(context_, zmq::socket_type::dealer),
      monitor_(context_, zmq::socket_type::pair) {
  socket_.set(zmq::sockopt::ipv6, endpoint_.find('[') != std::string::npos);
  socket_.set(zmq::sockopt::tcp_keepalive, 1);
  socket_.set(zmq::sockopt::sndtimeo, static_cast<int>(longest_wait_to_send.count()));
  socket_.set(zmq::sockopt::linger, 0);
  socket_.set(zmq::sockopt::maxmsgsize, static_cast<std::int64_t>(longest_message));
  monitor_.set(zmq::sockopt::linger, 0);
  zmq_socket_monitor(socket_.handle(), monitor_address, monitored);
  monitor_.connect(monitor_address);
  set_keys(options);
  try {
    socket_.connect(endpoint_);
  } catch (const zmq::error_t& error) {
    throw std::invalid_argument("'" + endpoint_ + "': not an endpoint to connect to (" +
                                error.what() + "); write ipc:///path or tcp://host:port");
  }
}

ZeroMq::~ZeroMq() {
  // Kept for good in a forked child, where they can't be closed.
  if (is_parents()) new std::tuple(std::move(monitor_), std::move(socket_), std::move(context_));
}

/// Encrypts the connection, if the options name keys.
void ZeroMq::set_keys(const SessionOptions& options) {
  if (options.server_key.empty() && options.curve_secret.empty()) return;
  if (options.server_key.empty() || options.curve_secret.empty()) {
    throw std::invalid_argument(
        "only one of server_key and curve_secret is set; an encrypted connection needs both");
  }
  std::error_code error;
  const bool is_file =
      std::filesystem::is_regular_file(options.curve_secret, error);  // no pipe: it could wait
  std::ifstream file(is_file ? options.curve_secret : "");
  std::string secret, more;
  std::array<char, 41> own;
  if (!(file >> secret) || file >> more || zmq_curve_public(own.data(), secret.c_str()) != 0) {
    throw std::invalid_argument(
        "'" + options.curve_secret +
        "': not a file with one secret key and nothing else; create one with 'ziggurat keygen'");
  }
  try {
    if (options.server_key.size() != 40) throw zmq::error_t(EINVAL);
    socket_.set(zmq::sockopt::curve_serverkey, options.server_key);
  } catch (const zmq::error_t&) {
    throw std::invalid_argument("'" + options.server_key +
                                "': not a public key; it has 40 characters and is printed by "
                                "'ziggurat keygen'");
  }
  has_keys_ = true;
  socket_.set(zmq::sockopt::curve_publickey, own.data());
  socket_.set(zmq::sockopt::curve_secretkey, secret);
}

void ZeroMq::linger() {
  if (is_parents()) return;
  try {
    take_events();
    if (!is_open_ || is_closed_) return;
    socket_.set(zmq::sockopt::linger, static_cast<int>(longest_linger.count()));
  } catch (const zmq::error_t&) {
    // The last messages may be lost; there is nothing else to do.
  }
}

void ZeroMq::send(std::size_t size, const std::function<void(char*)>& write) {
  if (is_parents())
    throw ConnectionError(endpoint_ +
                          ": can't send: the connection is that of the program that was forked");
  zmq::message_t frame(size);
  write(frame.data<char>());
  for (;;) {
    try {
      if (socket_.send(frame, zmq::send_flags::none)) return;
      // ZeroMQ drops the queue of a connection that the server has refused.
      if (was_closed())
        throw ConnectionError(endpoint_ + ": can't send: the server closed the connection");
    } catch (const zmq::error_t& error) {
      if (error.num() == EINTR) continue;
      throw ConnectionError(endpoint_ + ": can't send: " + error.what());
    }
  }
}

bool ZeroMq::receive(milliseconds timeout) {
  try {
    if (receive_from(socket_, frame_, zmq::recv_flags::dontwait)) return true;
    if (take_events()) return false;
    // These descriptors tell what comes after both sockets were found empty; zmq_poll() asks them
    // twice.
    pollfd waiting[] = {{socket_fd_, POLLIN, 0}, {monitor_fd_, POLLIN, 0}};
    ::poll(waiting, 2, static_cast<int>(timeout.count()));
    return receive_from(socket_, frame_, zmq::recv_flags::dontwait);
  } catch (const zmq::error_t& error) {
    throw ConnectionError(endpoint_ + ": can't receive: " + error.what());
  }
}

bool ZeroMq::was_closed() {
  take_events();
  if (!is_open_ && !refusal_.empty()) throw ConnectionError(endpoint_ + ": " + refusal_);
  return is_closed_;
}

bool ZeroMq::is_accepted() {
  take_events();
  return is_accepted_;
}

/// @return  whether there were any
bool ZeroMq::take_events() {
  bool were_any = false;
  constexpr std::size_t value_at = sizeof(std::uint16_t);
  zmq::message_t event;
  while (receive_from(monitor_, event, zmq::recv_flags::dontwait)) {
    std::uint16_t number = 0;
    std::uint32_t value = 0;
    if (event.size() >= value_at + sizeof value) {
      std::memcpy(&number, event.data(), sizeof number);
      std::memcpy(&value, event.data<char>() + value_at, sizeof value);
    }
    while (event.more()) receive_from(monitor_, event, zmq::recv_flags::none);  // the address
    take_event(number, value);
    were_any = true;
  }
  return were_any;
}

void ZeroMq::take_event(std::uint16_t event, std::uint32_t value) {
  if (event == ZMQ_EVENT_CONNECTED) {
    is_accepted_ = true;
  } else if (event == ZMQ_EVENT_HANDSHAKE_SUCCEEDED) {
    is_open_ = true;
  } else if (event == ZMQ_EVENT_DISCONNECTED) {
    is_accepted_ = false;
    is_closed_ |= is_open_;
  } else if (event == ZMQ_EVENT_HANDSHAKE_FAILED_AUTH) {
    refusal_ = "refused key? The server does not have this client's key in its --curve-clients";
  } else if (event == ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL &&
             value == ZMQ_PROTOCOL_ERROR_ZMTP_MECHANISM_MISMATCH) {
    refusal_ = has_keys_ ? "the endpoint is not protected; leave out the keys" : keys_are_missing;
  } else if (++failed_handshakes_ >= most_failed_handshakes && has_keys_) {
    refusal_ =
        "refused key? The server breaks off the handshake; compare the server's public key with "
        "the one that 'ziggurat keygen' has printed";
  }
}

}  // namespace

std::unique_ptr<Transport> make_transport(const SessionOptions& options) {
  check_endpoint(options.endpoint);
  return std::make_unique<ZeroMq>(options);
}

}  // namespace ziggurat
