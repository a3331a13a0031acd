#include "local_stream.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "ziggurat/error.h"

namespace ziggurat {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds between_tries{50};
constexpr milliseconds longest_linger{1000};
constexpr std::size_t greeting_size = 64;
constexpr std::size_t least_free = 4096;    // of the input before a read [bytes]
constexpr std::size_t most_kept = 1 << 20;  // of a buffer that is empty [bytes]
constexpr std::size_t short_body = 255;     // the longest with its size in one byte
constexpr std::size_t longest_command = 2048;
constexpr unsigned more_flag = 1, long_flag = 2, command_flag = 4;

std::string our_greeting() {
  std::string greeting(greeting_size, '\0');
  greeting[0] = '\xff';
  greeting[8] = 1;  // what older versions take for a length
  greeting[9] = '\x7f';
  greeting[10] = 3;
  greeting[11] = 1;
  greeting.replace(12, 4, "NULL");
  return greeting;
}

/// Appends a frame's header.
void append_header(std::string& to, unsigned flags, std::size_t body) {
  if (body <= short_body) {
    to += static_cast<char>(flags);
    to += static_cast<char>(body);
    return;
  }
  to += static_cast<char>(flags | long_flag);
  for (int shift = 56; shift >= 0; shift -= 8) to += static_cast<char>(body >> shift & 0xff);
}

std::string command(std::string_view name, std::string_view data) {
  std::string out;
  append_header(out, command_flag, 1 + name.size() + data.size());
  out += static_cast<char>(name.size());
  out += name;
  out += data;
  return out;
}

std::string our_ready() {
  std::string data;
  const auto property = [&](std::string_view name, std::string_view value) {
    data += static_cast<char>(name.size());
    data += name;
    data += {0, 0, 0, static_cast<char>(value.size())};
    data += value;
  };
  property("Socket-Type", "DEALER");
  property("Identity", "");
  return command("READY", data);
}

}  // namespace

std::optional<std::string> LocalStream::path_of(const Options& options) {
  constexpr std::string_view scheme = "ipc://";
  if (!options.endpoint.starts_with(scheme)) return std::nullopt;
  if (!options.server_key.empty() || !options.curve_secret.empty()) return std::nullopt;
  std::string path = options.endpoint.substr(scheme.size());
  const bool is_plain = !path.empty() && path[0] != '@' && path[0] != '*';
  if (!is_plain || path.size() >= sizeof(sockaddr_un::sun_path)) return std::nullopt;
  return path;
}

LocalStream::LocalStream(const Options& options) : path_(path_of(options).value()) { connect(); }

LocalStream::~LocalStream() {
  const auto end = Clock::now() + longest_linger;
  while (lingers_ && stage_ == Stage::open && sent_ < output_.size() && Clock::now() < end) {
    pollfd waiting{socket_, POLLOUT, 0};
    ::poll(&waiting, 1, 10);
    flush();
  }
  // What has arrived is read: the server would take an unread rest for a broken connection.
  while (stage_ != Stage::closed && fill()) filled_ = taken_ = 0;
  close();
}

void LocalStream::connect() {
  next_try_ = Clock::now() + between_tries;
  socket_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket_ < 0) return;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::copy(path_.begin(), path_.end(), address.sun_path);
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    return close();
  }
  stage_ = Stage::greeting;
  handshake_ = our_greeting() + our_ready();
  flush();
}

void LocalStream::close() {
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
  stage_ = Stage::closed;
  output_.erase(0, sent_);  // a message that was sent in part is lost, as all before it
  sent_ = 0;
}

/// Sends what the connection takes now.
void LocalStream::flush() {
  while (stage_ != Stage::closed) {
    const bool greets = !handshake_.empty();
    if (!greets && (stage_ != Stage::open || sent_ == output_.size())) break;
    const std::string_view rest =
        greets ? std::string_view(handshake_) : std::string_view(output_).substr(sent_);
    const ssize_t count = ::send(socket_, rest.data(), rest.size(), MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
    // What the server sent before it closed the connection may still be read.
    if (count < 0) return;
    if (greets) {
      handshake_.erase(0, static_cast<std::size_t>(count));
    } else {
      sent_ += static_cast<std::size_t>(count);
    }
  }
  if (sent_ < output_.size()) return;
  output_.clear();
  sent_ = 0;
  if (output_.capacity() > most_kept) output_.shrink_to_fit();
}

void LocalStream::send(std::size_t size, const std::function<void(char*)>& write) {
  append_header(output_, 0, size);
  const std::size_t at = output_.size();
  output_.resize(at + size);
  write(output_.data() + at);
  flush();
}

/// Reads what has arrived.
/// @return  whether there was something; closes the connection at its end
bool LocalStream::fill() {
  if (taken_ > 0) {
    std::copy(input_.begin() + static_cast<std::ptrdiff_t>(taken_),
              input_.begin() + static_cast<std::ptrdiff_t>(filled_), input_.begin());
    filled_ -= taken_;
    taken_ = 0;
    if (filled_ == 0 && input_.size() > most_kept) {
      input_.resize(least_free);
      input_.shrink_to_fit();
    }
  }
  if (input_.size() < filled_ + least_free)
    input_.resize(std::max(2 * filled_, filled_ + least_free));
  for (;;) {
    const ssize_t count = ::recv(socket_, input_.data() + filled_, input_.size() - filled_, 0);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return false;
    if (count <= 0) {
      close();
      return false;
    }
    filled_ += static_cast<std::size_t>(count);
    return true;
  }
}

bool LocalStream::was_closed() {
  if (is_protected_) throw ConnectionError("ipc://" + path_ + ": " + keys_are_missing);
  return was_open_ && stage_ == Stage::closed;
}

LocalStream::Step LocalStream::take_greeting() {
  if (filled_ - taken_ < greeting_size) return Step::incomplete;
  const std::string_view greeting(input_.data() + taken_, greeting_size);
  taken_ += greeting_size;
  if (greeting[0] != '\xff' || greeting[10] < 3 ||
      greeting.substr(12, 5) != std::string_view("NULL", 5)) {
    is_protected_ = greeting.substr(12, 5) == "CURVE";
    close();
    return Step::incomplete;
  }
  stage_ = Stage::ready;
  return Step::passed;
}

/// @return  false if the connection must be closed
bool LocalStream::take_command(std::string_view body) {
  const auto is = [&](std::string_view name) {
    return body.size() > name.size() && static_cast<unsigned char>(body[0]) == name.size() &&
           body.substr(1, name.size()) == name;
  };
  if (stage_ == Stage::ready) {
    if (!is("READY")) return false;
    stage_ = Stage::open;
    was_open_ = true;
    flush();
  } else if (is("PING") && body.size() >= 7) {  // its name, a time to live, a context
    if (sent_ == output_.size()) output_.clear(), sent_ = 0;
    output_ += command("PONG", body.substr(7).substr(0, 16));
    flush();
  }
  return true;
}

/// Takes the first frame of the input.
LocalStream::Step LocalStream::take() {
  if (stage_ == Stage::greeting) return take_greeting();
  const auto* bytes = reinterpret_cast<const unsigned char*>(input_.data()) + taken_;
  const std::size_t size = filled_ - taken_;
  if (size < 2) return Step::incomplete;
  const unsigned flags = bytes[0];
  const bool is_long = (flags & long_flag) != 0, is_command = (flags & command_flag) != 0;
  const std::size_t header = is_long ? 9 : 2;
  const bool is_known = flags <= (more_flag | long_flag | command_flag);
  if (is_known && size < header) return Step::incomplete;
  std::uint64_t body = 0;
  for (std::size_t i = 1; i < header && is_known; ++i) body = body << 8 | bytes[i];
  const bool is_allowed = is_known && body < SIZE_MAX / 4 &&
                          (!is_command || body <= longest_command) &&
                          (stage_ == Stage::open || is_command);
  if (!is_allowed) {
    close();
    return Step::incomplete;
  }
  if (size - header < body) return Step::incomplete;
  const std::string_view content(input_.data() + taken_ + header, static_cast<std::size_t>(body));
  taken_ += header + content.size();
  if (!is_command) {
    content_ = content;
    has_more_ = (flags & more_flag) != 0;
    return Step::message;
  }
  if (!take_command(content)) close();
  return Step::passed;
}

/// Waits until something arrives, or may be sent.
/// @return  false after the time-out or a signal
bool LocalStream::wait(Clock::time_point end) {
  const auto now = Clock::now();
  const auto until = stage_ == Stage::closed ? std::min(end, next_try_) : end;
  const auto left = std::chrono::ceil<milliseconds>(until - now).count();
  const bool has_output = !handshake_.empty() || (stage_ == Stage::open && sent_ < output_.size());
  pollfd waiting{socket_, static_cast<short>(POLLIN | (has_output ? POLLOUT : 0)), 0};
  const int count =
      ::poll(&waiting, socket_ >= 0 ? 1 : 0, static_cast<int>(std::max<long>(left, 0)));
  if (count < 0) return false;
  if (count > 0 && (waiting.revents & POLLOUT) != 0) flush();
  return count > 0 || (until < end && Clock::now() < end);
}

bool LocalStream::receive(milliseconds timeout) {
  const auto end = Clock::now() + timeout;
  for (;;) {
    while (stage_ != Stage::closed) {
      const Step step = take();
      if (step == Step::message) return true;
      if (step == Step::incomplete && (stage_ == Stage::closed || !fill())) break;
    }
    if (stage_ == Stage::closed) {
      if (was_open_) return false;
      filled_ = taken_ = 0;
      if (Clock::now() >= next_try_) connect();
    }
    if (!wait(end)) return false;
  }
}

}  // namespace ziggurat
