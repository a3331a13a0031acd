// SPDX-License-Identifier: MIT
#pragma once
// stdout or stderr: writing never waits for its reader. What the reader does not take waits in
// memory up to a limit; lines beyond it are dropped and counted. Preparation of these streams.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace ziggurat::text {

class BufferedStream {
 public:
  /// @param descriptor  open for writing; it stays open, and its flags as they are
  /// @param most        bytes that may wait
  explicit BufferedStream(int descriptor, std::size_t most = std::size_t{16} << 20);
  ~BufferedStream();
  BufferedStream(const BufferedStream&) = delete;
  BufferedStream& operator=(const BufferedStream&) = delete;

  /// Appends text to write, in order. It is dropped if too much waits already.
  void add(std::string_view text);
  /// The same for what must not be lost, whatever waits.
  void add_always(std::string_view text);

  /// Writes what the reader takes now. @returns 0, or the error number if it can't be written any
  /// more
  int write();
  /// Waits until everything is written. @returns the same
  /// @param most  wall time; negative: forever
  int finish(std::chrono::milliseconds most = std::chrono::milliseconds{-1});

  bool is_empty() const { return begin_ == waiting_.size(); }
  /// Texts that were dropped since the last call.
  std::uint64_t take_dropped();

 private:
  int write_once(int wait_ms);

  int descriptor_;  // the stream's own
  int own_ = -1;    // the same pipe or terminal, opened so that writing does not wait; -1: none
  bool is_file_;    // whose reader can't keep us waiting
  std::size_t most_;
  std::string waiting_;
  std::size_t begin_ = 0;  // of what is not yet written
  std::uint64_t dropped_ = 0;
};

/// Prepares the output of main(), which calls it first. It calls open_standard_streams(). A file
/// that grows beyond `ulimit -f` becomes an error of write() instead of SIGXFSZ.
void prepare_output();

/// Opens /dev/null for each of stdin, stdout and stderr that the parent has closed (`>&-`):
/// otherwise the first file or socket that is opened would get its number, and what is printed.
void open_standard_streams();

}  // namespace ziggurat::text
