// SPDX-License-Identifier: MIT
#pragma once
// Source of a reader's bytes.

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace ziggurat::mcap {

/// Bytes of a file are not as they must be.
class Damaged : public std::runtime_error {
 public:
  /// @param text  a sentence without a full stop
  Damaged(std::uint64_t offset, const std::string& text)
      : std::runtime_error(text), offset_(offset) {}
  std::uint64_t offset() const { return offset_; }  ///< from the start of the file

 private:
  std::uint64_t offset_;
};

struct Source {
  std::uint64_t size = 0;  ///< [bytes]
  /// Appends bytes. @throws std::runtime_error if they can't be read
  std::function<void(std::uint64_t offset, std::size_t size, std::string& to)> read;
};

/// A regular file. Its size is that of now, also if it grows.
/// @throws std::runtime_error that names the file
Source open_file(const std::string& path);

/// @param bytes  must outlive the source
Source bytes_of(std::string_view bytes);

}  // namespace ziggurat::mcap
