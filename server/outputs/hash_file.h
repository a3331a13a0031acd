// SPDX-License-Identifier: MIT
#pragma once
// The state hash of every tick: `--hash-file`.

#include <fmt/format.h>

#include <cstdint>
#include <string>

#include "math/hash.h"
#include "outputs/output_file.h"

namespace ziggurat::outputs {

/// `hash <tick> <16 lower-case hexadecimal digits>`, without line feed.
inline std::string hash_line(std::uint64_t tick, std::uint64_t hash) {
  return fmt::format("hash {} {}", tick, math::to_hex(hash));
}

class HashFile {
 public:
  /// @throws WriteError
  explicit HashFile(std::string path) : file_(std::move(path)) {}

  /// @throws WriteError
  void write(std::uint64_t tick, std::uint64_t hash) {
    file_.buffer().append(hash_line(tick, hash) + "\n");
    file_.written();
  }
  void flush() { file_.flush(); }  ///< @throws WriteError
  void close() { file_.close(); }

 private:
  OutputFile file_;
};

}  // namespace ziggurat::outputs
