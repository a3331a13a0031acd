// SPDX-License-Identifier: MIT
#pragma once
// State as bytes. A struct with a state lists its fields once, in a function archive(Archive&). It
// writes them, reads them back, and names them, so that two states can be compared field by field.
// Bytes that are read are checked: their number, sizes, indices, and that numbers are finite.

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "math/pose.h"

namespace ziggurat::math {

/// Bytes that are not a state of this world: names the field.
struct ArchiveError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Archive {
 public:
  /// Offset of a field in the bytes.
  struct Place {
    std::size_t offset = 0;
    std::string path;  ///< as in `physics/core/system/trees/3/q`
  };

  /// Writes. Bytes are appended.
  /// @param places  gets the place of each field in ascending order; null: they are not wanted
  static Archive writer(std::vector<std::byte>& out, std::vector<Place>* places = nullptr);
  /// Reads. @param in  must outlive it
  static Archive reader(std::span<const std::byte> in);

  bool reads() const { return out_ == nullptr; }
  std::size_t left() const { return in_.size(); }  ///< not read yet [bytes]

  /// A field. A list keeps the length that it has: that of the world that is read into.
  /// @throws ArchiveError
  template <class T>
  void operator()(std::string_view name, T& value) {
    const Scope scope(*this, name);
    any(value);
  }
  /// A list that may get another length. What is read takes memory only as its elements are there.
  /// @param most  elements, if one of them may take fewer bytes than a quarter of its memory
  template <class List>
  void list(std::string_view name, List& values, std::size_t most = unbounded) {
    using T = typename List::value_type;
    if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::byte>) {
      const Scope scope(*this, name);
      resize(values);
      any(values);
    } else {
      list(
          name, values, [this](T& value) { any(value); }, most);
    }
  }
  /// The same with elements that are archived by a function.
  template <class List, class Each>
  void list(std::string_view name, List& values, const Each& each, std::size_t most = unbounded) {
    const Scope scope(*this, name);
    const std::size_t size = count(values.size(), 1);
    require(size <= most, "has more elements than this world can have");
    if (values.size() > size) values.resize(size);
    for (std::size_t i = 0; i < size; ++i) {
      if (i == values.size()) values.emplace_back();
      numbered(i, values[i], each);
    }
  }
  /// A number that may be infinite or not a number.
  void any_number(std::string_view name, double& value) {
    const Scope scope(*this, name);
    raw(&value, sizeof value);
  }
  /// Bytes of a type that has no fields to list. @pre is trivially copyable
  void raw(void* value, std::size_t size);

  /// @throws ArchiveError that names the field under way, if it is read and the condition is false
  void require(bool condition, const char* what) const {
    if (reads() && !condition) fail(what);
  }

  /// The number of elements that follow: written, or read.
  /// @param size  that each has at least [bytes]
  /// @return  at most as many as the bytes left are enough for
  std::size_t count(std::size_t number, std::size_t size);

 private:
  static constexpr auto unbounded = std::numeric_limits<std::size_t>::max();

  class Scope {
   public:
    Scope(Archive& archive, std::string_view name) : archive_(archive) {
      archive_.names_.push_back(name);
      if (archive_.places_) archive_.note_place();
    }
    ~Scope() { archive_.names_.pop_back(); }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    Archive& archive_;
  };

  [[noreturn]] void fail(const char* what) const;
  std::string path() const;
  void note_place();
  void numbers(double* values, std::size_t count);

  template <std::integral T>
  void integer(T& value) {
    raw(&value, sizeof value);
  }
  template <class List>
  void resize(List& values) {
    const std::size_t size = count(values.size(), sizeof(typename List::value_type));
    if (reads()) values.resize(size);
  }

  void any(bool& value) {
    auto byte = static_cast<std::uint8_t>(value);
    raw(&byte, 1);
    require(byte <= 1, "is neither true nor false");
    value = byte == 1;
  }
  template <std::integral T>
  void any(T& value) {
    integer(value);
  }
  void any(double& value) { numbers(&value, 1); }
  template <int rows, int columns>
  void any(Eigen::Matrix<double, rows, columns>& value) {
    static_assert(rows > 0 && columns > 0);
    numbers(value.data(), static_cast<std::size_t>(rows * columns));
  }
  void any(Quaternion& value) {
    numbers(value.coeffs().data(), 4);
    require(is_rotation(value), "is no rotation");
  }
  void any(Pose& value) {
    any(value.position);
    any(value.orientation);
  }
  void any(std::string& value) {
    resize(value);
    raw(value.data(), value.size());
  }
  void any(std::vector<bool>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      bool value = values[i];
      any(value);
      values[i] = value;
    }
  }
  template <class T>
  void any(std::optional<T>& value) {
    bool has_value = value.has_value();
    any(has_value);
    if (!has_value) return value.reset();
    if (!value) value.emplace();
    any(*value);
  }
  template <class List>
  requires requires(List& list) { std::span(list); }
  void any(List& values) {
    using T = typename decltype(std::span(values))::element_type;
    if constexpr (std::is_same_v<T, double>) {
      numbers(values.data(), values.size());
    } else if constexpr (std::is_same_v<T, std::byte> ||
                         (std::integral<T> && !std::is_same_v<T, bool>)) {
      raw(values.data(), values.size() * sizeof(T));
    } else {
      std::size_t i = 0;
      for (T& value : values) numbered(i++, value, [this](T& each) { any(each); });
    }
  }
  /// An element of a list.
  template <class T, class Each>
  void numbered(std::size_t number, T& value, const Each& each) {
    if (!places_) return each(value);
    const std::string name = std::to_string(number);
    const Scope scope(*this, name);
    each(value);
  }
  /// A struct: its own function, or one beside it.
  template <class T>
  requires requires(T& value, Archive& archive) { value.archive(archive); }
  void any(T& value) { value.archive(*this); }
  template <class T>
  requires requires(T& value, Archive& archive) { archive_fields(archive, value); }
  void any(T& value) { archive_fields(*this, value); }

  std::span<const std::byte> in_;
  std::vector<std::byte>* out_ = nullptr;  // null: it reads
  std::vector<Place>* places_ = nullptr;
  std::vector<std::string_view> names_;  // of the field under way, behind those that it is in
};

/// A value of an enumeration. @param last  the largest that is allowed
template <class Enumeration>
void archive_choice(Archive& archive, std::string_view name, Enumeration& value, Enumeration last) {
  using Number = std::underlying_type_t<Enumeration>;
  auto number = static_cast<Number>(value);
  archive(name, number);
  archive.require(number <= static_cast<Number>(last), "has a value that is none");
  value = static_cast<Enumeration>(number);
}

/// A position in a list. @param count  of the list
inline void archive_index(Archive& archive, std::string_view name, std::size_t& value,
                          std::size_t count) {
  archive(name, value);
  archive.require(value < count, "has an index beyond its list");
}

/// The field that holds a byte. @param places  ascending
std::string field_at(std::span<const Archive::Place> places, std::size_t offset);

}  // namespace ziggurat::math
