#include "plain_stream.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "ziggurat/error.h"

namespace ziggurat {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds between_tries{50}, between_tries_of_hosts{100};
constexpr milliseconds between_looks{20};  // at whether an address was found
constexpr milliseconds longest_handshake{30'000};
constexpr std::size_t least_free = 4096;    // of the input before a read [bytes]
constexpr unsigned most_commands = 1000;    // or parts of a message, one after the other, before a look at the time
constexpr std::size_t most_kept = 1 << 20;  // of a buffer that is empty [bytes]
constexpr std::size_t longest_queue = std::size_t{64} << 20;  // of what is to be sent: above it, sending waits [bytes]

}  // namespace

PlainStream::PlainStream(PlainEndpoint endpoint) : endpoint_(std::move(endpoint)) { go_on(); }

PlainStream::~PlainStream() {
  const auto end = Clock::now() + longest_linger;
  while (lingers_ && stage_ == Stage::open && !is_broken_ && sent_ < output_.size() && Clock::now() < end) {
    pollfd waiting{socket_, POLLOUT, 0};
    ::poll(&waiting, 1, 10);
    flush();
  }
  // Input is read to its end: the server would take an unread rest for a broken connection.
  while (is_connected() && Clock::now() < end && fill()) filled_ = taken_ = 0;
  close();
}

/// Goes on with connecting, as far as that does not wait.
void PlainStream::go_on() {
  if (stage_ == Stage::closed && !was_open_ && Clock::now() >= next_try_) {
    next_try_ = Clock::now() + (endpoint_.is_path() ? between_tries : between_tries_of_hosts);
    address_ = endpoint_.address();
    stage_ = Stage::looking_up;
  }
  if (stage_ == Stage::looking_up && address_.wait_for(milliseconds{0}) == std::future_status::ready) connect();
  if (stage_ == Stage::connecting) {
    pollfd connected{socket_, POLLOUT, 0};
    int error = 0;
    socklen_t size = sizeof error;
    if (::poll(&connected, 1, 0) <= 0) return;
    if (::getsockopt(socket_, SOL_SOCKET, SO_ERROR, &error, &size) != 0 || error != 0) return close();
    greet();
  }
  const bool shakes_hands = stage_ == Stage::greeting || stage_ == Stage::ready;
  if (shakes_hands && Clock::now() >= handshake_end_) close();
}

void PlainStream::connect() {
  SocketAddress address;
  try {
    address = address_.get();
  } catch (const std::future_error&) {
    // There was no thread to look it up.
  }
  stage_ = Stage::closed;
  if (address.size == 0) return;
  socket_ = ::socket(address.bytes.ss_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket_ < 0) return;
  if (!endpoint_.is_path()) {
    const int on = 1;
    ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    ::setsockopt(socket_, SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
  }
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address.bytes), address.size) == 0) return greet();
  if (errno != EINPROGRESS) return close();
  stage_ = Stage::connecting;
}

void PlainStream::greet() {
  stage_ = Stage::greeting;
  filled_ = taken_ = frame_ = 0;
  is_broken_ = false;
  handshake_end_ = Clock::now() + longest_handshake;
  handshake_ = zmtp::greeting("NULL", false).substr(0, zmtp::first_of_greeting);
  has_greeted_ = false;
  flush();
}

void PlainStream::close() {
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
  stage_ = Stage::closed;
  output_.erase(0, sent_);  // a message that was sent in part is lost, as all before it
  sent_ = 0;
}

bool PlainStream::has_output() const {
  return stage_ == Stage::connecting || (is_connected() && !handshake_.empty()) ||
         (stage_ == Stage::open && sent_ < output_.size());
}

/// Sends what the connection takes now.
void PlainStream::flush() {
  while (is_connected() && has_output()) {
    const bool greets = !handshake_.empty();
    const std::string_view rest =
        greets ? std::string_view(handshake_) : std::string_view(output_).substr(sent_);
    const ssize_t count = ::send(socket_, rest.data(), rest.size(), MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      // Input that the server sent before it closed the connection may still be read.
      is_broken_ = errno != EAGAIN && errno != EWOULDBLOCK;
      break;
    }
    if (greets) {
      handshake_.erase(0, static_cast<std::size_t>(count));
    } else {
      sent_ += static_cast<std::size_t>(count);
    }
  }
  const bool is_all_sent = sent_ == output_.size();
  if (!is_all_sent && (sent_ < most_kept || sent_ < output_.size() / 2)) return;
  output_.erase(0, sent_);
  sent_ = 0;
  if (is_all_sent && output_.capacity() > most_kept) output_.shrink_to_fit();
}

/// Waits while too much is queued.
void PlainStream::make_room() {
  for (;;) {
    go_on();
    while (is_connected() && stage_ != Stage::open && (take() == Step::passed || (is_connected() && fill()))) {
    }
    if (is_protected_) throw ConnectionError(endpoint_.text() + ": " + keys_are_missing);
    if (output_.size() - sent_ < longest_queue) return;
    if (is_broken_ || (was_open_ && stage_ == Stage::closed)) {
      throw ConnectionError(endpoint_.text() + ": can't send: the server closed the connection");
    }
    wait(Clock::now() + longest_linger, stage_ == Stage::open ? POLLRDHUP : POLLIN);
  }
}

void PlainStream::send(std::size_t size, const std::function<void(char*)>& write) {
  if (stage_ != Stage::open || output_.size() - sent_ >= longest_queue) make_room();
  const std::size_t header_at = output_.size();
  const std::size_t at = header_at + zmtp::header_length(size);
  output_.resize(at + size);
  zmtp::write_header(size, reinterpret_cast<std::uint8_t*>(output_.data()) + header_at);
  write(output_.data() + at);
  flush();
}

/// Reads what has arrived.
/// @return  whether there was something; closes the connection at its end
bool PlainStream::fill() {
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
  if (input_.size() < filled_ + least_free) {
    // No more than the rest of a frame that is begun: it may be the longest.
    input_.resize(std::max(std::min(2 * filled_, frame_ + least_free), filled_ + least_free));
  }
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

bool PlainStream::was_closed() {
  if (is_protected_) throw ConnectionError(endpoint_.text() + ": " + keys_are_missing);
  return was_open_ && stage_ == Stage::closed;
}

void PlainStream::end_greeting() {
  if (std::exchange(has_greeted_, true)) return;
  handshake_ += zmtp::greeting("NULL", false).substr(zmtp::first_of_greeting);
  flush();
}

PlainStream::Step PlainStream::take_greeting(zmtp::Bytes input) {
  const zmtp::Greeting found = zmtp::check_greeting(input);
  if (found == zmtp::Greeting::incomplete) {
    if (input.size() >= zmtp::first_of_greeting) end_greeting();
    return Step::incomplete;
  }
  const bool is_whole = found == zmtp::Greeting::whole;
  is_protected_ = is_whole && zmtp::mechanism_of(input) == "CURVE";
  if (!is_whole || zmtp::mechanism_of(input) != "NULL") {
    close();
    return Step::incomplete;
  }
  taken_ += zmtp::greeting_size;
  stage_ = Stage::ready;
  end_greeting();
  // Not earlier: who closes the connection without reading it resets that, and the greeting can get lost.
  zmtp::append_command(handshake_, "READY", zmtp::metadata_of("DEALER"));
  flush();
  return Step::passed;
}

/// @return  false if the connection must be closed
bool PlainStream::take_command(zmtp::Bytes body) {
  if (stage_ == Stage::ready) {
    const auto metadata = zmtp::command_data(body, "READY");
    // A connection to a free port of this machine can be one to itself.
    if (!metadata || zmtp::read_metadata(*metadata).socket_type != "ROUTER") return false;
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
PlainStream::Step PlainStream::take() {
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
  frame_ = header->length + size;
  if (input.size() - header->length < size) return Step::incomplete;
  const zmtp::Bytes body = input.subspan(header->length, size);
  taken_ += std::exchange(frame_, 0);
  if (!header->is_command) {
    content_ = zmtp::text_of(body);
    has_more_ = header->has_more;
    return Step::message;
  }
  if (!take_command(body)) close();
  return Step::passed;
}

/// Waits until something arrives, or may be sent, or it is time to go on with connecting.
/// @param events  POLLIN, or POLLRDHUP to leave what arrives where it is
/// @return  false after the time-out or a signal
bool PlainStream::wait(Clock::time_point end, short events) {
  const auto now = Clock::now();
  auto until = end;
  if (stage_ == Stage::closed) until = std::min(end, next_try_);
  if (stage_ == Stage::looking_up) until = std::min(end, now + between_looks);
  if (stage_ == Stage::greeting || stage_ == Stage::ready) until = std::min(end, handshake_end_);
  const auto left = std::chrono::ceil<milliseconds>(until - now).count();
  pollfd waiting{socket_, static_cast<short>(events | (has_output() ? POLLOUT : 0)), 0};
  const int count =
      ::poll(&waiting, socket_ >= 0 ? 1 : 0, static_cast<int>(std::max<long>(left, 0)));
  if (count < 0) return false;
  if (count > 0 && (waiting.revents & POLLOUT) != 0) flush();
  if (count > 0 && (waiting.revents & POLLRDHUP) != 0) is_broken_ = true;
  return count > 0 || (until < end && Clock::now() < end);
}

bool PlainStream::receive(milliseconds timeout) {
  const auto end = Clock::now() + timeout;
  unsigned commands = 0, reads = 0;
  for (;;) {
    if (stage_ != Stage::open) go_on();
    while (is_connected()) {
      const Step step = take();
      if (step == Step::message) return true;
      if (step == Step::passed && ++commands > most_commands && Clock::now() > end) return false;
      if (step == Step::incomplete && (!is_connected() || !fill())) break;
      if (step == Step::incomplete && ++reads > most_commands && Clock::now() > end) return false;
    }
    if (stage_ == Stage::closed && was_open_) return false;
    if (!wait(end, POLLIN)) return false;
  }
}

}  // namespace ziggurat
