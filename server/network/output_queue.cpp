// SPDX-License-Identifier: MIT
#include "network/output_queue.h"

#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "network/limits.h"

namespace ziggurat::network {
namespace {

constexpr std::size_t flushed_at_once = 256 * kibibyte;  // others are looked at after so much

}  // namespace

void Buffer::reserve(std::size_t size) {
  if (capacity >= size) return;
  bytes.reset();
  capacity = 0;
  bytes = std::make_unique_for_overwrite<std::uint8_t[]>(size);
  capacity = size;
}

std::size_t OutputQueue::write(std::span<const std::uint8_t> bytes) {
  const ssize_t size = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  if (size >= 0) return static_cast<std::size_t>(size);
  if (errno != EAGAIN && errno != EINTR) has_failed_ = true;
  return 0;
}

/// The frame, in memory of about its own size: a frame may have far more, of earlier messages.
Buffer OutputQueue::kept(Buffer& frame, std::size_t size) {
  if (frame.capacity <= size + size / 4) return std::exchange(frame, {});
  Buffer copy;
  copy.reserve(size);
  std::memcpy(copy.bytes.get(), frame.bytes.get(), size);
  return copy;
}

void OutputQueue::send(Buffer& frame, std::size_t size, MessageKind kind) {
  const std::size_t sent = waiting_.empty() ? write({frame.bytes.get(), size}) : 0;
  if (sent == size || has_failed_) return;
  Parcel parcel{kept(frame, size), size, sent, kind};
  if (kind == MessageKind::observation) {
    std::erase_if(waiting_, [](const Parcel& each) {
      return each.kind == MessageKind::observation && each.sent == 0;
    });
  } else {
    const bool is_alone = waiting_bytes_ == 0;
    is_congested_ = !is_alone && waiting_bytes_ - alone_ + parcel.memory() > most_waiting;
    if (is_congested_) return;
    if (is_alone && parcel.memory() > most_waiting) alone_ = parcel.memory();
    waiting_bytes_ += parcel.memory();
  }
  waiting_.push_back(std::move(parcel));
}

void OutputQueue::flush() {
  for (std::size_t left = flushed_at_once; left > 0 && !waiting_.empty() && !has_failed_;) {
    Parcel& first = waiting_.front();
    const std::size_t wanted = std::min(left, first.size - first.sent);
    const std::size_t sent = write({first.frame.bytes.get() + first.sent, wanted});
    first.sent += sent;
    left -= sent;
    if (first.sent < first.size && sent < wanted) return;
    if (first.sent < first.size) continue;
    if (first.kind != MessageKind::observation) {
      waiting_bytes_ -= first.memory();
      alone_ = 0;
    }
    waiting_.pop_front();
  }
}

void OutputQueue::drop() {
  waiting_.clear();
  waiting_bytes_ = alone_ = 0;
}

}  // namespace ziggurat::network
