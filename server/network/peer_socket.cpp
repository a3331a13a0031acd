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

constexpr std::size_t least_space = 8 * kibibyte;  // for one read

/// How much memory an idle connection keeps.
std::size_t kept_when_idle(Standing standing) {
  return standing == Standing::controller ? mebibyte : least_space;
}

}  // namespace

PeerSocket::PeerSocket(std::string name, posix::Descriptor descriptor, const zmtp::CurveKeys* keys,
                       bool is_trusted, Time now)
    : name_(std::move(name)),
      descriptor_(std::move(descriptor)),
      engine_(keys),
      is_trusted_(is_trusted),
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
  const ssize_t size = ::recv(number(), input_.bytes.get() + end_, input_.capacity - end_, 0);
  if (size > 0) {
    end_ += static_cast<std::size_t>(size);
  } else if (size == 0 || (errno != EAGAIN && errno != EINTR)) {
    is_over_ = true;
  }
}

/// Passes over a frame that is too long. True if that was the end of its message.
bool PeerSocket::skip(Received& received) {
  const std::size_t here = std::min(to_skip_, end_ - begin_);
  begin_ += here;
  to_skip_ -= here;
  return to_skip_ == 0 && end_message(more_to_skip_, received);
}

/// A frame of a message is over. True if the message is, too.
bool PeerSocket::end_message(bool has_more, Received& received) {
  const bool is_first = !std::exchange(has_frames_, has_more);
  if (has_more) return false;
  received.connection = name_;
  received.is_single_frame = is_first;
  received.several_frames = first_frame_;
  received.access = engine_.access();
  received.skipped = std::exchange(skipped_, 0);
  if (received.skipped > 0) received.bytes = {};
  return true;
}

bool PeerSocket::next(std::size_t limit, Received& received) {
  while (!is_over_) {
    if (to_skip_ > 0) {
      if (skip(received)) return true;
      if (to_skip_ > 0) break;
      continue;
    }
    const std::span input(input_.bytes.get() + begin_, end_ - begin_);
    const zmtp::Taken taken = engine_.take(input, limit, reply_);
    if (!reply_.empty()) send_reply();
    needed_ = taken.size;
    if (taken.step == Step::incomplete) {
      if (begin_ == end_) let_go();
      return false;
    }
    if (taken.step == Step::failed) {
      is_over_ = true;
    } else if (taken.step == Step::too_long) {
      // It is passed over and told, or the connection is over.
      is_over_ = standing_ == Standing::none || taken.size / 2 > limit;
      to_skip_ = skipped_ = taken.size;
      more_to_skip_ = taken.has_more;
    } else {
      begin_ += taken.size;
      needed_ = 0;
      if (taken.step == Step::passed) continue;
      received.bytes = zmtp::text_of(taken.content);
      if (!has_frames_) first_frame_ = wire::encoding_of(received.bytes);
      if (end_message(taken.has_more, received)) return true;
    }
  }
  let_go();
  return false;
}

void PeerSocket::send(Buffer& frame, std::size_t content, bool is_observation) {
  const std::size_t size = engine_.content_at(content) + content;
  engine_.seal({frame.bytes.get(), size}, content);
  send_bytes(frame, size, is_observation);
}

void PeerSocket::send_bytes(Buffer& frame, std::size_t size, bool is_observation) {
  if (is_over_) return;
  output_.send(frame, size, is_observation);
  is_over_ = output_.has_failed() || output_.is_congested();
}

void PeerSocket::send_reply() {
  Buffer frame;
  frame.reserve(reply_.size());
  std::memcpy(frame.bytes.get(), reply_.data(), reply_.size());
  send_bytes(frame, reply_.size(), false);
  reply_.clear();
}

void PeerSocket::give_up() {
  is_over_ = true;
  output_.drop();
}

void PeerSocket::flush() {
  if (is_over_) return;
  output_.flush();
  is_over_ = output_.has_failed();
}

}  // namespace ziggurat::network
