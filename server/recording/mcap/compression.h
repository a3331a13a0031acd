// SPDX-License-Identifier: MIT
#pragma once
// Chunks' bytes, compressed and back.

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "recording/mcap/records.h"

struct ZSTD_CCtx_s;

namespace ziggurat::mcap {

class Compressor {
 public:
  explicit Compressor(Compression compression);
  ~Compressor();
  Compressor(const Compressor&) = delete;
  Compressor& operator=(const Compressor&) = delete;

  Compression compression() const { return compression_; }
  /// The compressed bytes, which stay until the next call. @throws std::bad_alloc
  std::string_view compress(std::string_view bytes);

 private:
  const Compression compression_;
  ZSTD_CCtx_s* zstd_ = nullptr;
  std::string compressed_;  // its memory is used again
};

/// Undoes it.
/// @param name  as in the file: empty, `lz4` or `zstd`
/// @param size  that the result must have; memory for it is taken at once
/// @param to    is replaced
/// @return  what is wrong, as a sentence without a subject; empty: nothing
std::string decompress(std::string_view name, std::string_view bytes, std::size_t size,
                       std::string& to);

}  // namespace ziggurat::mcap
