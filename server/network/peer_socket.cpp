// SPDX-License-Identifier: MIT
#include "network/peer_socket.h"

#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>
#include <utility>

namespace ziggurat::network {
namespace {

using Step = zmtp::Taken::Step;

constexpr std::size_t least_space = 8 * kibibyte;     // for one read
constexpr std::size_t read_at_once = 256 * kibibyte;  // others are looked at after so much,
constexpr int frames_at_once = 16;                    // and after so many

/// Memory that an idle connection keeps [bytes].
std::size_t kept_when_idle(Standing standing) {
  return standing == Standing::controller ? mebibyte : least_space;
}

}  // namespace

PeerSocket::PeerSocket(std::string name, posix::Descriptor descriptor, const zmtp::CurveKeys* keys,
                       Trust trust, Time now)
    : name_(std::move(name)),
      descriptor_(std::move(descriptor)),
      engine_(keys),
      trust_(trust),
      since_(now),
      reply_(engine_.greeting()),
      output_(descriptor_.number()) {
  send_reply();
}

void PeerSocket::set_standing(Standing standing, std::size_t longest, Time now) {
  standing_ = standing;
  longest_ = longest;
  if (standing == Standing::none) since_ = now;
}

/// Space behind end_ for the rest of the frame, as far as about as much has arrived already: a
/// header alone takes no memory.
void PeerSocket::enlarge() {
  const std::size_t have = end_ - begin_;
  const std::size_t wanted = std::clamp(needed_, have + least_space, 2 * have + least_space);
  if (input_.capacity - begin_ >= wanted) return;
  if (input_.capacity >= wanted) {
    std::memmove(input_.bytes.get(), input_.bytes.get() + begin_, have);
  } else {
    Buffer larger;
    larger.reserve(wanted);
    if (have > 0) std::memcpy(larger.bytes.get(), input_.bytes.get() + begin_, have);
    input_ = std::move(larger);
  }
  begin_ = 0;
  end_ = have;
}

/// Everything that has arrived is used up.
void PeerSocket::let_go() {
  begin_ = end_ = 0;
  if (input_.capacity > kept_when_idle(standing_)) input_ = {};
}

void PeerSocket::read() {
  try {
    enlarge();
  } catch (const std::bad_alloc&) {
    return give_up();
  }
  const ssize_t size = ::recv(number(), input_.bytes.get() + end_,
                              std::min(input_.capacity - end_, read_at_once), 0);
  if (size > 0) {
    end_ += static_cast<std::size_t>(size);
  } else if (size == 0 || (errno != EAGAIN && errno != EINTR)) {
    is_over_ = true;
  }
}

/// A frame of a message is over. True if the message is, too.
bool PeerSocket::end_message(bool goes_on, Received& received) {
  const bool is_first = !std::exchange(has_frames_, goes_on);
  if (goes_on) return false;
  received.connection = name_;
  received.is_single_frame = is_first;
  received.several_frames = first_frame_;
  received.access = engine_.access();
  received.skipped = std::exchange(skipped_, 0);
  return true;
}

std::string PeerSocket::fault() const {
  const std::string& why = too_long_.empty() ? engine_.refusal() : too_long_;
  if (why.empty()) return {};
  return (is_open() ? "A client was disconnected: " : "A client was refused: ") + why + ".";
}

/// True if a message is complete. What is answered waits in reply_.
bool PeerSocket::take_frame(std::size_t limit, Received& received) {
  if (to_skip_ > 0) {
    const std::size_t here = std::min(to_skip_, end_ - begin_);
    begin_ += here;
    to_skip_ -= here;
    has_more = to_skip_ == 0;
    received.bytes = {};
    return has_more && end_message(more_to_skip_, received);
  }
  const std::span input(input_.bytes.get() + begin_, end_ - begin_);
  const zmtp::Taken taken = engine_.take(input, limit, reply_);
  needed_ = taken.size;
  has_more = taken.step != Step::incomplete;
  if (taken.step == Step::failed) {
    has_failed_ = true;
  } else if (taken.step == Step::too_long) {
    // It is passed over and told, or the connection is over.
    if (standing_ == Standing::none || taken.size / 2 > limit) {
      has_failed_ = true;
      too_long_ = "a message of its has about " + std::to_string(taken.size) + " bytes, and " +
                  std::to_string(limit) + " are allowed";
      return false;
    }
    to_skip_ = taken.size;
    skipped_ += taken.size;
    more_to_skip_ = taken.has_more;
  } else if (has_more) {
    begin_ += taken.size;
    needed_ = 0;
    if (taken.step == Step::passed) return false;
    received.bytes = zmtp::text_of(taken.content);
    if (!has_frames_) first_frame_ = wire::encoding_of(received.bytes);
    if (taken.has_more) skipped_ += taken.content.size();
    return end_message(taken.has_more, received);
  }
  return false;
}

bool PeerSocket::next(std::size_t limit, Received& received) {
  bool has_message = false;
  has_more = true;
  for (int frame = 0;
       frame < frames_at_once && !has_message && has_more && !has_failed_ && !is_over_; ++frame) {
    has_message = take_frame(limit, received);
  }
  if (!reply_.empty()) send_reply();
  is_over_ |= has_failed_;
  if (has_message) return true;
  if (begin_ == end_ || is_over_) let_go();
  return false;
}

void PeerSocket::send(Buffer& frame, std::size_t content, MessageKind kind) {
  const std::size_t size = engine_.content_at(content) + content;
  engine_.seal({frame.bytes.get(), size}, content);
  send_bytes(frame, size, kind);
}

void PeerSocket::send_bytes(Buffer& frame, std::size_t size, MessageKind kind) {
  if (is_over_) return;
  output_.send(frame, size, kind);
  is_over_ = output_.is_congested() || (output_.has_failed() && !has_input());
}

/// A client that says its last words and closes its end can't be sent anything, but read.
bool PeerSocket::has_input() const {
  std::uint8_t first = 0;
  return begin_ != end_ || ::recv(number(), &first, 1, MSG_PEEK | MSG_DONTWAIT) > 0;
}

void PeerSocket::send_reply() {
  Buffer frame;
  frame.reserve(reply_.size());
  std::memcpy(frame.bytes.get(), reply_.data(), reply_.size());
  send_bytes(frame, reply_.size(), MessageKind::other);
  reply_.clear();
}

void PeerSocket::give_up() {
  is_over_ = true;
  output_.drop();
}

void PeerSocket::flush() {
  if (is_over_) return;
  output_.flush();
  is_over_ = output_.has_failed() && !has_input();
}

}  // namespace ziggurat::network
