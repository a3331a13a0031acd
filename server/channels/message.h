// SPDX-License-Identifier: MIT
#pragma once
// Messages of channels, encoded.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace ziggurat::channels {

/// The bytes of a message. Those of pictures are made when they are asked for first, on the thread
/// that asks, so that pictures that no viewer gets cost nothing.
class Content {
 public:
  explicit Content(std::string bytes) : held_(bytes.size()), bytes_(std::move(bytes)) {}
  /// @param held  what `make` keeps in memory until then [bytes]
  Content(std::function<std::string()> make, std::size_t held)
      : held_(held), make_(std::move(make)) {}
  Content(const Content&) = delete;
  Content& operator=(const Content&) = delete;

  const std::string& bytes() const {
    std::call_once(once_, [this] {
      if (make_) bytes_ = make_();
      make_ = nullptr;
    });
    return bytes_;
  }
  /// Memory of a message, about [bytes].
  std::size_t held() const { return held_; }

 private:
  std::size_t held_;
  mutable std::once_flag once_;
  mutable std::function<std::string()> make_;
  mutable std::string bytes_;
};

struct Message {
  std::uint32_t channel = 0;  ///< Channel::id
  std::int64_t time_ns = 0;   ///< simulated
  std::shared_ptr<const Content> content;
  bool must_arrive = false;  ///< latched, or an event: no later message replaces it at each tick
};

}  // namespace ziggurat::channels
