// SPDX-License-Identifier: MIT
#pragma once
// An output of a command that a signal ends at once: it appears under its name when it is whole.

#include <string>

namespace ziggurat::cli {

/// One at a time. What SIGINT, SIGTERM or SIGHUP interrupts is removed, and told.
class AtomicFile {
 public:
  /// @param out  is replaced at the end; `-`, a pipe or a device is written to directly
  explicit AtomicFile(std::string out);
  /// Removes what was not kept.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Path to write to; close the file before commit().
  const std::string& path() const { return part_; }

  /// It is whole. @throws std::runtime_error  a sentence
  void commit();

 private:
  std::string out_, target_, part_;  // target_: behind links; empty: directly
};

}  // namespace ziggurat::cli
