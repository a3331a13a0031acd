#pragma once
// The CRC-32 of MCAP: that of zlib.

#include <zlib.h>

#include <cstdint>
#include <string_view>

namespace ziggurat::mcap {

/// @param so_far  of the bytes before
inline std::uint32_t crc32(std::string_view bytes, std::uint32_t so_far = 0) {
  return static_cast<std::uint32_t>(
      ::crc32_z(so_far, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace ziggurat::mcap
