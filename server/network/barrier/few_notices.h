#pragma once
// Sentences on messages that were wrong, which peers can cause any number of times.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace ziggurat::network {

/// The first 20 are told at once, then one a second, with the number of those before it that were not.
class FewNotices {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// @param sentence  with its full stop
  /// @returns what is to be told, if anything
  std::optional<std::string> add(std::string sentence, Time now) {
    const auto seconds = std::chrono::floor<std::chrono::seconds>(now - since_);
    left_ = std::min<std::int64_t>(at_once, left_ + seconds.count());
    since_ += seconds;
    if (left_ == 0) {
      ++untold_;
      return std::nullopt;
    }
    --left_;
    if (const std::uint64_t others = std::exchange(untold_, 0); others > 0) {
      sentence += " (" + std::to_string(others) + " more before it.)";
    }
    return sentence;
  }

 private:
  static constexpr std::int64_t at_once = 20;
  std::int64_t left_ = at_once;
  Time since_{};  // up to when seconds have been counted
  std::uint64_t untold_ = 0;
};

}  // namespace ziggurat::network
