// SPDX-License-Identifier: MIT
#include "math/hash.h"

#include <array>
#include <bit>
#include <cstdio>
#include <utility>

#define XXH_STATIC_LINKING_ONLY  // the state's size, to hold it by value
#include <xxhash.h>

namespace ziggurat::math {

struct Hash::State {
  XXH64_state_t xxh;
  std::array<std::uint64_t, 64> values{};  // not in it yet: an update takes longer than a value
  std::size_t count = 0;

  void add(std::uint64_t value) {
    if (count == values.size()) flush();
    values[count++] = value;
  }
  void add(const void* bytes, std::size_t size) {
    flush();
    XXH64_update(&xxh, bytes, size);
  }
  void flush() {
    if (count > 0) XXH64_update(&xxh, values.data(), std::exchange(count, 0) * sizeof values[0]);
  }
};

Hash::Hash() : state_(std::make_unique<State>()) { XXH64_reset(&state_->xxh, 0); }
Hash::~Hash() = default;

void Hash::add(std::uint64_t value) { state_->add(value); }
void Hash::add(double value) { state_->add(std::bit_cast<std::uint64_t>(value)); }
void Hash::add(std::span<const double> values) {
  if (values.size() > state_->values.size()) return state_->add(values.data(), values.size_bytes());
  for (const double value : values) add(value);
}
void Hash::add(std::string_view text) {
  add(static_cast<std::uint64_t>(text.size()));
  state_->add(text.data(), text.size());
}
std::uint64_t Hash::digest() const {
  state_->flush();
  return XXH64_digest(&state_->xxh);
}

std::string to_hex(std::uint64_t digest) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(digest));
  return text;
}

}  // namespace ziggurat::math
