#include "math/hash.h"

#include <cstdio>

#define XXH_STATIC_LINKING_ONLY  // the state's size, to hold it by value
#include <xxhash.h>

namespace ziggurat::math {

struct Hash::State {
  XXH64_state_t xxh;
};

Hash::Hash() : state_(std::make_unique<State>()) { XXH64_reset(&state_->xxh, 0); }
Hash::~Hash() = default;

void Hash::add(std::uint64_t value) { XXH64_update(&state_->xxh, &value, sizeof value); }
void Hash::add(double value) { XXH64_update(&state_->xxh, &value, sizeof value); }
void Hash::add(std::span<const double> values) {
  XXH64_update(&state_->xxh, values.data(), values.size_bytes());
}
void Hash::add(std::string_view text) {
  add(static_cast<std::uint64_t>(text.size()));
  XXH64_update(&state_->xxh, text.data(), text.size());
}
std::uint64_t Hash::digest() const { return XXH64_digest(&state_->xxh); }

std::string to_hex(std::uint64_t digest) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(digest));
  return text;
}

}  // namespace ziggurat::math
