#pragma once
// Size of the readings in a message to a session.

#include <cstddef>

namespace ziggurat::wire {

/// Readings of a session at a tick, counted before there is a message with them (docs/protocol.md,
/// D5).
struct ReadingSize {
  std::size_t payloads = 0;  ///< content of radio messages and tags [bytes]
  std::size_t size = 0;      ///< of its share of the message, with these payloads [bytes]
  std::size_t memory = 0;    ///< that decoding it takes, at most [bytes]

  /// @param each_size    what each adds to `size`, at least [bytes]
  /// @param each_memory  and to `memory`, at most [bytes]
  void add(std::size_t count, std::size_t each_size, std::size_t each_memory) {
    size += count * each_size;
    memory += count * each_memory;
  }
  /// @param bytes  of any content
  void add_content(std::size_t bytes) { add(1, bytes, bytes); }
  void add_payload(std::size_t bytes) {
    payloads += bytes;
    add_content(bytes);
  }
};

}  // namespace ziggurat::wire
