#include "local_transport.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <utility>
#include <vector>

#include "ziggurat/error.h"
#include "zmtp/frame.h"

namespace ziggurat {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr milliseconds slice{500};  // of a wait for the system
constexpr milliseconds between_attempts{20};
constexpr milliseconds longest_linger{1000};
constexpr std::size_t read_at_once = std::size_t{64} << 10;  // [bytes]
constexpr std::size_t kept_for_frames = std::size_t{1} << 20;

/// A descriptor that is closed with its owner.
class OwnSocket {
 public:
  OwnSocket() = default;
  OwnSocket(const OwnSocket&) = delete;
  OwnSocket& operator=(const OwnSocket&) = delete;
  ~OwnSocket() { reset(); }
  void reset(int descriptor = -1) {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = descriptor;
  }
  bool is_open() const { return descriptor_ >= 0; }
  int number() const { return descriptor_; }

 private:
  int descriptor_ = -1;
};

class LocalTransport final : public Transport {
 public:
  LocalTransport(const std::string& endpoint, const char* keys_are_missing);
  ~LocalTransport() override;

  void send(std::size_t size, const std::function<void(char*)>& write) override;
  bool receive(milliseconds timeout) override;
  std::string_view content() override { return content_; }
  bool has_more() const override { return has_more_; }
  bool was_closed() override;
  bool is_accepted() override { return socket_.is_open() && !is_closed_; }
  void linger() override { lingers_ = true; }

 private:
  /// Whether the program was forked since: the connection is the parent's.
  bool is_parents() const { return ::getpid() != process_; }
  void connect();
  void lose();
  std::size_t write_now(std::string_view bytes);
  void flush();
  bool is_readable(milliseconds timeout);
  bool read(milliseconds timeout);
  void make_space();
  bool take_greeting();
  bool next();
  bool take_frame(const zmtp::Header& header);
  zmtp::Bytes input() const { return {input_.data() + begin_, end_ - begin_}; }

  const pid_t process_ = ::getpid();
  const std::string endpoint_;
  const char* const keys_are_missing_;
  sockaddr_un address_{};
  socklen_t address_size_ = sizeof address_;
  OwnSocket socket_;
  bool has_greeting_ = false, is_open_ = false, is_closed_ = false, lingers_ = false;
  std::string refusal_;   // why the connection is left; empty: it is not
  std::string waiting_;   // output for after the handshake, or when the server reads again
  std::string outgoing_;  // the frame that is sent
  std::vector<std::uint8_t> input_;  // what has arrived is from begin_ to end_
  std::size_t begin_ = 0, end_ = 0;  // [bytes]
  std::size_t needed_ = 0;           // of the frame that begins there [bytes]
  std::string_view content_;         // within the input
  bool has_more_ = false;
};

LocalTransport::LocalTransport(const std::string& endpoint, const char* keys_are_missing)
    : endpoint_(endpoint), keys_are_missing_(keys_are_missing) {
  const std::string path = endpoint.substr(endpoint.find("//") + 2);
  constexpr std::size_t longest = sizeof address_.sun_path - 1;
  if (path.empty() || path == "@" || path == "*" || path.size() > longest) {
    throw std::invalid_argument("'" + endpoint + "': the path must have 1 to " +
                                std::to_string(longest) + " bytes; write ipc:///path");
  }
  address_.sun_family = AF_UNIX;
  std::ranges::copy(path, address_.sun_path);
  if (path[0] == '@') {  // a name without a file
    address_.sun_path[0] = '\0';
    address_size_ = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + path.size());
  }
  connect();
}

LocalTransport::~LocalTransport() {
  if (is_parents()) return;
  const auto end = Clock::now() + longest_linger;
  while (lingers_ && is_open_ && !is_closed_ && !waiting_.empty() && Clock::now() < end) flush();
}

void LocalTransport::connect() {
  socket_.reset(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const timeval time{0, slice / std::chrono::microseconds{1}};
  ::setsockopt(socket_.number(), SOL_SOCKET, SO_RCVTIMEO, &time, sizeof time);
  ::setsockopt(socket_.number(), SOL_SOCKET, SO_SNDTIMEO, &time, sizeof time);
  has_greeting_ = false;
  begin_ = end_ = needed_ = 0;
  std::string handshake = zmtp::greeting("NULL", false);
  zmtp::append_command(handshake, "READY", zmtp::metadata_of("DEALER"));
  const auto* address = reinterpret_cast<const sockaddr*>(&address_);
  if (::connect(socket_.number(), address, address_size_) != 0 ||
      write_now(handshake) < handshake.size()) {
    socket_.reset();
  }
}

/// The connection has ended. Within its handshake another is tried: a server that ends, or has no
/// place, breaks it off, too.
void LocalTransport::lose() {
  if (is_open_) {
    is_closed_ = true;
  } else {
    socket_.reset();
  }
}

bool LocalTransport::was_closed() {
  if (!refusal_.empty()) throw ConnectionError(endpoint_ + ": " + refusal_);
  return is_closed_;
}

std::size_t LocalTransport::write_now(std::string_view bytes) {
  const ssize_t size = ::send(socket_.number(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
  if (size >= 0) return static_cast<std::size_t>(size);
  if (errno != EAGAIN && errno != EINTR) lose();
  return 0;
}

void LocalTransport::flush() { waiting_.erase(0, write_now(waiting_)); }

void LocalTransport::send(std::size_t size, const std::function<void(char*)>& write) {
  if (is_parents())
    throw ConnectionError(endpoint_ +
                          ": can't send: the connection is that of the program that was forked");
  while (is_open_ && !is_closed_ && !waiting_.empty()) flush();
  if (was_closed())
    throw ConnectionError(endpoint_ + ": can't send: the server closed the connection");
  const std::size_t header = zmtp::header_length(size), whole = header + size;
  if (outgoing_.size() < whole) outgoing_.resize(whole);
  zmtp::write_header(size, reinterpret_cast<std::uint8_t*>(outgoing_.data()));
  write(outgoing_.data() + header);
  const std::string_view frame(outgoing_.data(), whole);
  waiting_ += frame.substr(is_open_ ? write_now(frame) : 0);
  if (outgoing_.size() > kept_for_frames) outgoing_ = {};
}

bool LocalTransport::receive(milliseconds timeout) {
  content_ = {};
  const auto end = Clock::now() + timeout;
  for (milliseconds rest = timeout;;) {
    if (next()) return true;
    if (is_closed_ || !refusal_.empty()) return false;
    if (socket_.is_open() && !read(rest)) return false;
    if (!socket_.is_open()) {
      const auto pause = std::min(rest, between_attempts);
      if (::poll(nullptr, 0, static_cast<int>(pause.count())) < 0) return false;
      connect();
    }
    rest = std::max(std::chrono::ceil<milliseconds>(end - Clock::now()), milliseconds{0});
    if (rest.count() == 0 && !socket_.is_open()) return false;
  }
}

/// Sends meanwhile what waits.
bool LocalTransport::is_readable(milliseconds timeout) {
  const bool has_output = is_open_ && !waiting_.empty();
  pollfd one{socket_.number(), static_cast<short>(POLLIN | (has_output ? POLLOUT : 0)), 0};
  if (::poll(&one, 1, static_cast<int>(timeout.count())) <= 0) return false;
  if ((one.revents & POLLOUT) != 0) flush();
  return (one.revents & ~POLLOUT) != 0;
}

/// Waits no longer than a slice. False: nothing has arrived in that time, or a signal has.
bool LocalTransport::read(milliseconds timeout) {
  if ((timeout < slice || !waiting_.empty()) && !is_readable(timeout)) return false;
  make_space();
  const ssize_t size = ::recv(socket_.number(), input_.data() + end_, input_.size() - end_, 0);
  if (size < 0 && (errno == EAGAIN || errno == EINTR)) return false;
  if (size > 0) {
    end_ += static_cast<std::size_t>(size);
  } else {
    lose();
  }
  return true;
}

/// Space behind end_ for the rest of the frame, as far as about as much has arrived already: a
/// header alone takes no memory.
void LocalTransport::make_space() {
  const std::size_t have = end_ - begin_;
  std::memmove(input_.data(), input_.data() + begin_, have);
  begin_ = 0;
  end_ = have;
  const std::size_t wanted = std::clamp(needed_, have + read_at_once, 2 * have + read_at_once);
  if (input_.size() < wanted) input_.resize(wanted);
  if (have == 0 && input_.size() > kept_for_frames) std::vector<std::uint8_t>(wanted).swap(input_);
}

/// True if all of it is there.
bool LocalTransport::take_greeting() {
  const zmtp::Greeting found = zmtp::check_greeting(input());
  if (found == zmtp::Greeting::wrong) refusal_ = "what listens there does not speak ZMTP 3";
  if (found != zmtp::Greeting::whole) return false;
  if (zmtp::mechanism_of(input()) != "NULL") {
    refusal_ = keys_are_missing_;
    return false;
  }
  begin_ += zmtp::greeting_size;
  return has_greeting_ = true;
}

/// The next message of what has arrived.
bool LocalTransport::next() {
  while (refusal_.empty() && end_ - begin_ >= std::max(needed_, std::size_t{1})) {
    if (!has_greeting_) {
      if (!take_greeting()) return false;
      continue;
    }
    const auto header = zmtp::read_header(input());
    if (!header) return false;
    if (!header->is_valid || header->body > longest_message) {
      refusal_ = "its messages are none of ZMTP 3, or too long";
      return false;
    }
    needed_ = header->length + static_cast<std::size_t>(header->body);
    if (end_ - begin_ < needed_) return false;
    if (take_frame(*header)) return true;
  }
  return false;
}

/// Whether it is one of a message.
bool LocalTransport::take_frame(const zmtp::Header& header) {
  const zmtp::Bytes body = input().subspan(header.length, static_cast<std::size_t>(header.body));
  begin_ += std::exchange(needed_, 0);
  if (!header.is_command) {
    content_ = zmtp::text_of(body);
    has_more_ = header.has_more;
    return true;
  }
  if (!is_open_ && zmtp::command_data(body, "READY")) {
    is_open_ = true;
    if (!waiting_.empty()) flush();
  }
  return false;
}

}  // namespace

std::unique_ptr<Transport> make_local_transport(const std::string& endpoint,
                                                const char* keys_are_missing) {
  return std::make_unique<LocalTransport>(endpoint, keys_are_missing);
}

}  // namespace ziggurat
