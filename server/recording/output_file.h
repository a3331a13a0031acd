#pragma once
// A file being written. What stands in the buffer reaches the disk in large pieces, and a disk
// that takes no more is an error of its own, never a silently shortened file.

#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace ziggurat::recording {

/// A file cannot be created or written; the message names the file and the cause.
class WriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

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

  /// Writes the rest and closes; further calls do nothing. @throws WriteError
  void close();

 private:
  std::string path_;
  int descriptor_ = -1;
  fmt::memory_buffer buffer_;
};

}  // namespace ziggurat::recording
