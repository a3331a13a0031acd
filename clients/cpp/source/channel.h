// SPDX-License-Identifier: MIT
#pragma once
// Channels: the packed fields of observations and commands, over all robots of a session, and the
// values of handles that they fill or are filled from.

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <deque>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat {

/// @throws std::runtime_error naming both numbers
inline void expect(std::size_t received, std::size_t announced, const char* what) {
  if (received == announced) return;
  throw std::runtime_error("the server sent " + std::to_string(received) + " " + what +
                           "; it had announced " + std::to_string(announced));
}

class Channel {
 public:
  virtual ~Channel() = default;
  /// @throws std::runtime_error if the message is not what Welcome announced
  virtual void check(const v1::Observation&) const {}
  /// Reads a checked message, which stays unchanged until the next is read: handles may point into
  /// it.
  virtual void read(const v1::Observation&) {}
  virtual void write(v1::Command&) {}  ///< adds the values that were set after sent()
  virtual void sent() {}               ///< after the command was sent
  virtual void repeat() {}             ///< the next command has all values
  virtual void reset() {}              ///< all values become the initial ones
  virtual void load(v1::Command&) {}   ///< values become these, if the command has any
};

/// Sensors that read a fixed number of values each.
/// @tparam T  a reading: numbers in the order of the message, nothing else
template <typename T, typename Number = double>
class Readings final : public Channel {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(Number) == 0);

 public:
  using Field = const google::protobuf::RepeatedField<Number>& (v1::Observation::*)() const;

  Readings(const char* what, Field field) : what_(what), field_(field) {}
  /// The next device's, which stays where it is.
  void add(T& reading) { readings_.push_back(&reading); }

  void check(const v1::Observation& from) const override {
    expect(static_cast<std::size_t>((from.*field_)().size()), numbers * readings_.size(), what_);
  }
  void read(const v1::Observation& from) override {
    const Number* number = (from.*field_)().data();
    for (T* reading : readings_) {
      std::memcpy(static_cast<void*>(reading), number, sizeof(T));
      number += numbers;
    }
  }

 private:
  static constexpr std::size_t numbers = sizeof(T) / sizeof(Number);
  const char* what_;
  Field field_;
  std::vector<T*> readings_;
};

/// Actuators with one value each. All values are sent if one of them was set.
template <typename T, typename List = google::protobuf::RepeatedField<T>>
class Settings final : public Channel {
 public:
  using Field = List* (v1::Command::*)();

  explicit Settings(Field field) : field_(field) {}
  /// The next device's value, which stays where it is.
  T& add(T initial) {
    initial_.push_back(initial);
    return values_.emplace_back(std::move(initial));
  }
  /// Some value was set since sent().
  bool& changed() { return changed_; }

  void write(v1::Command& to) override {
    if (changed_) (to.*field_)()->Add(values_.begin(), values_.end());
  }
  void sent() override { changed_ = false; }
  void repeat() override { changed_ = true; }
  void load(v1::Command& from) override {
    const List& values = *(from.*field_)();
    if (static_cast<std::size_t>(values.size()) != values_.size()) return;
    std::copy(values.begin(), values.end(), values_.begin());
  }
  void reset() override {
    std::copy(initial_.begin(), initial_.end(), values_.begin());
    changed_ = false;
  }

 private:
  Field field_;
  std::deque<T> values_;  // handles point into it
  std::vector<T> initial_;
  bool changed_ = false;
};

/// In the order of their making.
using Channels = std::vector<std::unique_ptr<Channel>>;

}  // namespace ziggurat
