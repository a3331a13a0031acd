// SPDX-License-Identifier: MIT
#pragma once
// Output that waits to be sent over one connection. Its size is bounded; no call blocks.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>

#include "network/link.h"

namespace ziggurat::network {

/// Bytes without a value of their own at first.
struct Buffer {
  std::unique_ptr<std::uint8_t[]> bytes;
  std::size_t capacity = 0;

  /// Capacity for so many, whose content is lost if there was less. @throws std::bad_alloc
  void reserve(std::size_t size);
};

class OutputQueue {
 public:
  /// @param descriptor  of a socket that does not block
  explicit OutputQueue(int descriptor) : descriptor_(descriptor) {}

  /// Sends bytes now, or as soon as the client reads. A newer Observation takes the place of one
  /// that waits.
  /// @param frame  is taken if it has to wait
  void send(Buffer& frame, std::size_t size, MessageKind kind);
  /// Sends a part of what waits, as far as that is possible.
  void flush();

  /// Forgets what waits: nothing more is sent.
  void drop();

  bool is_empty() const { return waiting_.empty(); }
  /// Memory of what waits, without Observations.
  std::size_t waiting_bytes() const { return waiting_bytes_; }
  /// The connection is gone.
  bool has_failed() const { return has_failed_; }
  /// Too much waits: the client does not read.
  bool is_congested() const { return is_congested_; }

 private:
  struct Parcel {
    Buffer frame;
    std::size_t size = 0, sent = 0;
    MessageKind kind = MessageKind::other;

    /// Memory that the frame takes, at least [bytes].
    std::size_t memory() const { return frame.capacity + 128; }
  };
  static Buffer kept(Buffer& frame, std::size_t size);
  std::size_t write(std::span<const std::uint8_t> bytes);

  int descriptor_;
  std::deque<Parcel> waiting_;  // the first may be sent in part
  std::size_t waiting_bytes_ = 0;
  std::size_t alone_ = 0;  // of these, what the first takes if nothing waited before it: it may be
                           // longer than the bound
  bool has_failed_ = false, is_congested_ = false;
};

}  // namespace ziggurat::network
