#pragma once
// The state hash of every tick: `--hash-file`.

#include <cstdint>
#include <string>

#include "outputs/output_file.h"

namespace ziggurat::outputs {

/// `hash <tick> <16 lower-case hexadecimal digits>`, without line feed.
std::string hash_line(std::uint64_t tick, std::uint64_t hash);

class HashFile {
 public:
  /// @throws WriteError
  explicit HashFile(std::string path) : file_(std::move(path)) {}

  /// @throws WriteError
  void write(std::uint64_t tick, std::uint64_t hash);
  void flush() { file_.flush(); }  ///< @throws WriteError
  void close() { file_.close(); }

 private:
  OutputFile file_;
};

}  // namespace ziggurat::outputs
