// SPDX-License-Identifier: MIT
#pragma once
// Little-endian numbers and texts with their lengths, to bytes and back, and the CRC of bytes.
// Reading checks every length against what is left.

#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

namespace ziggurat::mcap {

/// The CRC-32 of zlib. @param so_far  of the bytes before
inline std::uint32_t crc32(std::string_view bytes, std::uint32_t so_far = 0) {
  return static_cast<std::uint32_t>(
      ::crc32_z(so_far, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

template <class Number>
void put(Number value, std::string& to) {
  static_assert(std::is_unsigned_v<Number>);
  for (std::size_t i = 0; i < sizeof value; ++i) {
    to.push_back(static_cast<char>(value >> (8 * i)));
  }
}
/// @param text  at most 4 GiB
inline void put_text(std::string_view text, std::string& to) {
  put(static_cast<std::uint32_t>(text.size()), to);
  to += text;
}

/// Reads one value after the other. After a value that does not fit all are 0 or empty.
class Bytes {
 public:
  explicit Bytes(std::string_view all) : left_(all) {}

  template <class Number>
  Number number() {
    const std::string_view bytes = take(sizeof(Number));
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      value |= std::uint64_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
    }
    return static_cast<Number>(value);
  }
  std::string_view text() { return take(number<std::uint32_t>()); }
  std::string_view long_text() { return take(number<std::uint64_t>()); }
  std::string_view rest() { return take(left_.size()); }

  std::size_t left() const { return left_.size(); }
  bool ok() const { return ok_; }

 private:
  std::string_view take(std::uint64_t size) {
    if (size > left_.size()) {
      ok_ = false;
      left_ = {};
      return {};
    }
    const std::string_view taken = left_.substr(0, static_cast<std::size_t>(size));
    left_.remove_prefix(taken.size());
    return taken;
  }

  std::string_view left_;
  bool ok_ = true;
};

}  // namespace ziggurat::mcap
