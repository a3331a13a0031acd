// SPDX-License-Identifier: MIT
#include "math/archive.h"

#include <algorithm>

namespace ziggurat::math {

Archive Archive::writer(std::vector<std::byte>& out, std::vector<Place>* places) {
  Archive archive;
  archive.out_ = &out;
  archive.places_ = places;
  return archive;
}

Archive Archive::reader(std::span<const std::byte> in) {
  Archive archive;
  archive.in_ = in;
  return archive;
}

void Archive::raw(void* value, std::size_t size) {
  if (size == 0) return;
  if (out_) {
    const auto* bytes = static_cast<const std::byte*>(value);
    out_->insert(out_->end(), bytes, bytes + size);
    return;
  }
  if (size > in_.size()) fail("is cut off");
  std::memcpy(value, in_.data(), size);
  in_ = in_.subspan(size);
}

void Archive::numbers(double* values, std::size_t count) {
  raw(values, count * sizeof(double));
  if (!reads()) return;
  double sum = 0;  // NaN, if one of them is not finite
  for (std::size_t i = 0; i < count; ++i) sum += 0 * values[i];
  if (sum != 0) fail("is not finite");
}

std::size_t Archive::count(std::size_t number, std::size_t size) {
  auto written = static_cast<std::uint64_t>(number);
  raw(&written, sizeof written);
  require(written <= in_.size() / size, "is longer than the bytes that are left");
  return static_cast<std::size_t>(written);
}

std::string Archive::path() const {
  std::string path;
  for (const std::string_view name : names_) {
    if (!path.empty()) path += '/';
    path += name;
  }
  return path;
}

void Archive::note_place() { places_->push_back({out_ ? out_->size() : 0, path()}); }

void Archive::fail(const char* what) const { throw ArchiveError("'" + path() + "' " + what); }

std::string field_at(std::span<const Archive::Place> places, std::size_t offset) {
  const auto after = std::ranges::upper_bound(places, offset, {}, &Archive::Place::offset);
  return after == places.begin() ? std::string() : (after - 1)->path;
}

}  // namespace ziggurat::math
