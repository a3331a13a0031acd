// SPDX-License-Identifier: MIT
#pragma once
// The file on disk, which has whole records only, also if the disk is full.

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>

namespace ziggurat::recorder {

class Disk {
 public:
  /// Creates the file, or empties it. @throws outputs::WriteError, also for a pipe without a
  /// reader and a file to which another program writes
  explicit Disk(std::string path);
  ~Disk();
  Disk(const Disk&) = delete;
  Disk& operator=(const Disk&) = delete;

  /// Writes all bytes, or takes what was written of them back. @throws outputs::WriteError, also
  /// if another program has removed or shortened the file
  void write(std::string_view bytes);
  /// @throws outputs::WriteError
  void close();

  // The other threads may call these while one writes.
  const std::string& path() const { return path_; }
  std::uint64_t taken() const { return taken_; }  ///< by the disk so far [bytes]
  /// A write that is under way fails when it returns, and all later ones do.
  void abandon() { is_abandoned_ = true; }
  bool is_abandoned() const { return is_abandoned_; }

 private:
  [[noreturn]] void fail(int error);
  void check_loss() const;

  std::string path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;  // of what was written whole [bytes]
  std::atomic<std::uint64_t> taken_ = 0;
  std::atomic<bool> is_abandoned_ = false;
};

}  // namespace ziggurat::recorder
