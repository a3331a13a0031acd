// SPDX-License-Identifier: MIT
#include "recording/mcap/compression.h"

#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

#include <new>

namespace ziggurat::mcap {
namespace {

constexpr int zstd_level = 1;  // twice as fast as the usual 3, a tenth larger

std::string decompress_zstd(std::string_view bytes, std::string& to) {
  const std::size_t size = ZSTD_decompress(to.data(), to.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(size)) return fmt::format("can't be decompressed ({})", ZSTD_getErrorName(size));
  if (size == to.size()) return {};
  return fmt::format("has {} bytes instead of {}", size, to.size());
}

std::string decompress_lz4(std::string_view bytes, std::string& to) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION))) throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      made, LZ4F_freeDecompressionContext);
  std::size_t written = 0, hint = 1;
  while (!bytes.empty() && hint != 0) {
    std::size_t taken = bytes.size(), given = to.size() - written;
    hint =
        LZ4F_decompress(context.get(), to.data() + written, &given, bytes.data(), &taken, nullptr);
    if (LZ4F_isError(hint)) {
      return fmt::format("can't be decompressed ({})", LZ4F_getErrorName(hint));
    }
    if (taken == 0 && given == 0) return fmt::format("has more than {} bytes", to.size());
    bytes.remove_prefix(taken);
    written += given;
  }
  if (hint != 0 || !bytes.empty()) return "is no whole frame of LZ4";
  if (written == to.size()) return {};
  return fmt::format("has {} bytes instead of {}", written, to.size());
}

}  // namespace

std::string_view name_of(Compression compression) {
  switch (compression) {
    case Compression::lz4:
      return "lz4";
    case Compression::zstd:
      return "zstd";
    case Compression::none:
      break;
  }
  return "";
}

Compressor::Compressor(Compression compression) : compression_(compression) {
  if (compression != Compression::zstd) return;
  zstd_ = ZSTD_createCCtx();
  if (!zstd_) throw std::bad_alloc();
  ZSTD_CCtx_setParameter(zstd_, ZSTD_c_compressionLevel, zstd_level);
}

Compressor::~Compressor() { ZSTD_freeCCtx(zstd_); }

std::string_view Compressor::compress(std::string_view bytes) {
  if (compression_ == Compression::none) return bytes;
  const bool is_zstd = compression_ == Compression::zstd;
  const std::size_t most =
      is_zstd ? ZSTD_compressBound(bytes.size()) : LZ4F_compressFrameBound(bytes.size(), nullptr);
  if (compressed_.size() < most) compressed_.resize(most);
  const std::size_t size =
      is_zstd ? ZSTD_compress2(zstd_, compressed_.data(), most, bytes.data(), bytes.size())
              : LZ4F_compressFrame(compressed_.data(), most, bytes.data(), bytes.size(), nullptr);
  // The result fits, so that memory is all that may be missing.
  if (is_zstd ? ZSTD_isError(size) : LZ4F_isError(size)) throw std::bad_alloc();
  return std::string_view(compressed_).substr(0, size);
}

std::string decompress(std::string_view name, std::string_view bytes, std::size_t size,
                       std::string& to) {
  if (name.empty()) {
    if (bytes.size() != size) return fmt::format("has {} bytes instead of {}", bytes.size(), size);
    to = bytes;
    return {};
  }
  if (name != "zstd" && name != "lz4") {
    return fmt::format("is compressed with '{}'; only zstd and lz4 are known", name.substr(0, 32));
  }
  to.resize(size);
  return name == "zstd" ? decompress_zstd(bytes, to) : decompress_lz4(bytes, to);
}

}  // namespace ziggurat::mcap
