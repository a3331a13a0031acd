// SPDX-License-Identifier: MIT
#pragma once
// A file being written. The buffer reaches the disk in large pieces. A full disk is an error of its
// own, never a silently shortened file.

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

namespace ziggurat::outputs {

/// A file cannot be created or written; the message names the file and the cause.
class WriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Opens a file to write to it alone, and empties it. What is written goes to its end, also behind
/// a program that shortens it. A pipe or a device may have several writers. @throws WriteError if
/// it can't be created, or another program writes to it, which would mix both
int open_alone(const std::string& path, int flags = 0);

/// Checks that open_alone() could open it. It stays as it is, and no file stays that was not there.
/// @throws WriteError
void check_can_be_written(const std::string& path);

/// Description of the damage to a file of open_alone() by another program, which removed or
/// shortened it; none: it is whole.
/// @param size  of the written content [bytes]
std::optional<std::string> loss_of(int descriptor, std::uint64_t size);

class OutputFile {
 public:
  /// Creates the file, or empties it; `-` is stdout. @throws WriteError
  explicit OutputFile(std::string path);
  /// Closes without writing what is still in the buffer: close() before is the good end.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Append here; then call written().
  fmt::memory_buffer& buffer() { return buffer_; }

  /// Call it after each whole line: a full buffer is written to the disk.
  /// @throws WriteError
  void written();

  /// Writes what is in the buffer. Call it between whole lines. @throws WriteError
  void flush();

  /// Writes the rest and closes; further calls do nothing. @throws WriteError, also if the file was
  /// removed or shortened meanwhile
  void close();

 private:
  std::string path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;  // of what was written [bytes]
  fmt::memory_buffer buffer_;
};

}  // namespace ziggurat::outputs
