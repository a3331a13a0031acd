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
constexpr std::size_t least_free = 4096;    // of the input before a read [bytes]
constexpr unsigned most_commands = 1000;    // or parts of a message, one after the other, before a look at the time
constexpr std::size_t most_kept = 1 << 20;  // of a buffer that is empty [bytes]

}  // namespace

std::optional<std::string> LocalStream::path_of(const SessionOptions& options) {
  constexpr std::string_view scheme = "ipc://";
  if (!options.endpoint.starts_with(scheme)) return std::nullopt;
  if (!options.server_key.empty() || !options.curve_secret.empty()) return std::nullopt;
  std::string path = options.endpoint.substr(scheme.size());
  const bool is_plain = !path.empty() && path[0] != '@' && path[0] != '*';
  if (!is_plain || path.size() >= sizeof(sockaddr_un::sun_path)) return std::nullopt;
  return path;
}

LocalStream::LocalStream(const SessionOptions& options) : path_(path_of(options).value()) { connect(); }

LocalStream::~LocalStream() {
  const auto end = Clock::now() + longest_linger;
  while (lingers_ && stage_ == Stage::open && sent_ < output_.size() && Clock::now() < end) {
    pollfd waiting{socket_, POLLOUT, 0};
    ::poll(&waiting, 1, 10);
    flush();
  }
  // What has arrived is read: the server would take an unread rest for a broken connection.
  while (stage_ != Stage::closed && Clock::now() < end && fill()) filled_ = taken_ = 0;
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
  handshake_ = zmtp::greeting("NULL", false);
  zmtp::append_command(handshake_, "READY", zmtp::metadata_of("DEALER"));
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
  const std::size_t header_at = output_.size();
  const std::size_t at = header_at + zmtp::header_length(size);
  output_.resize(at + size);
  zmtp::write_header(size, reinterpret_cast<std::uint8_t*>(output_.data()) + header_at);
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

LocalStream::Step LocalStream::take_greeting(zmtp::Bytes input) {
  const zmtp::Greeting found = zmtp::check_greeting(input);
  if (found == zmtp::Greeting::incomplete) return Step::incomplete;
  const bool is_whole = found == zmtp::Greeting::whole;
  is_protected_ = is_whole && zmtp::mechanism_of(input) == "CURVE";
  if (!is_whole || zmtp::mechanism_of(input) != "NULL") {
    close();
    return Step::incomplete;
  }
  taken_ += zmtp::greeting_size;
  stage_ = Stage::ready;
  return Step::passed;
}

/// @return  false if the connection must be closed
bool LocalStream::take_command(zmtp::Bytes body) {
  if (stage_ == Stage::ready) {
    if (!zmtp::command_data(body, "READY")) return false;
    stage_ = Stage::open;
    was_open_ = true;
    flush();
  } else if (const auto context = zmtp::ping_context(body); context && output_.size() - sent_ < most_kept) {
    if (sent_ == output_.size()) output_.clear(), sent_ = 0;
    zmtp::append_command(output_, "PONG", zmtp::text_of(*context));
    flush();
  }
  return true;
}

/// Takes the first frame of the input.
LocalStream::Step LocalStream::take() {
  const zmtp::Bytes input =
      zmtp::bytes_of(std::string_view(input_).substr(taken_, filled_ - taken_));
  if (stage_ == Stage::greeting) return take_greeting(input);
  const auto header = zmtp::read_header(input);
  if (!header) return Step::incomplete;
  const bool is_allowed = header->is_valid && header->body <= longest_message &&
                          (!header->is_command || header->body <= zmtp::longest_command) &&
                          (stage_ == Stage::open || header->is_command);
  if (!is_allowed) {
    close();
    return Step::incomplete;
  }
  const auto size = static_cast<std::size_t>(header->body);
  if (input.size() - header->length < size) return Step::incomplete;
  const zmtp::Bytes body = input.subspan(header->length, size);
  taken_ += header->length + size;
  if (!header->is_command) {
    content_ = zmtp::text_of(body);
    has_more_ = header->has_more;
    return Step::message;
  }
  if (!take_command(body)) close();
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
  unsigned commands = 0, reads = 0;
  for (;;) {
    while (stage_ != Stage::closed) {
      const Step step = take();
      if (step == Step::message) return true;
      if (step == Step::passed && ++commands > most_commands && Clock::now() > end) return false;
      if (step == Step::incomplete && (stage_ == Stage::closed || !fill())) break;
      if (step == Step::incomplete && ++reads > most_commands && Clock::now() > end) return false;
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
