// SPDX-License-Identifier: MIT
#pragma once
// The state hash: XXH64 over a canonical fixed-width layout, fed value by value.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace ziggurat::math {

class Hash {
 public:
  Hash();
  ~Hash();
  Hash(const Hash&) = delete;
  Hash& operator=(const Hash&) = delete;

  void add(std::uint64_t value);
  void add(double value);  ///< its bits, so that 0.0 and -0.0 differ
  void add(std::span<const double> values);
  void add(std::string_view text);  ///< length first, then the bytes

  std::uint64_t digest() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// 16 lower-case hexadecimal digits.
std::string to_hex(std::uint64_t digest);

}  // namespace ziggurat::math
