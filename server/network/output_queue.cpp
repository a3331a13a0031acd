#include "network/output_queue.h"

#include <sys/socket.h>

#include <cerrno>
#include <utility>

#include "network/limits.h"

namespace ziggurat::network {

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

void OutputQueue::send(Buffer& frame, std::size_t size, bool is_observation) {
  const std::size_t sent = waiting_.empty() ? write({frame.bytes.get(), size}) : 0;
  if (sent == size || has_failed_) return;
  if (is_observation) {
    std::erase_if(waiting_,
                  [](const Parcel& each) { return each.is_observation && each.sent == 0; });
  } else {
    is_congested_ = waiting_bytes_ > 0 && waiting_bytes_ + size > most_waiting;
    if (is_congested_) return;
    waiting_bytes_ += size;
  }
  waiting_.push_back({std::exchange(frame, {}), size, sent, is_observation});
}

void OutputQueue::flush() {
  while (!waiting_.empty() && !has_failed_) {
    Parcel& first = waiting_.front();
    first.sent += write({first.frame.bytes.get() + first.sent, first.size - first.sent});
    if (first.sent < first.size) return;
    if (!first.is_observation) waiting_bytes_ -= first.size;
    waiting_.pop_front();
  }
}

}  // namespace ziggurat::network
