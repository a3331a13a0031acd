#pragma once
// A sentence for people that peers can cause any number of times: it is told now and then, with how
// often it happened.

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace ziggurat::network {

class RareNotice {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// @param interval  between two sentences at least
  explicit RareNotice(Time::duration interval) : interval_(interval) {}

  /// It happened. Of several sentences the last one is told.
  /// @param sentence  without the full stop
  void add(std::string sentence) {
    ++count_;
    sentence_ = std::move(sentence);
  }

  /// The sentence, if there is one and the interval is over. Times must not go back.
  std::optional<std::string> take(Time now) {
    if (count_ == 0 || now < next_) return std::nullopt;
    next_ = now + interval_;
    const std::uint64_t others = std::exchange(count_, 0) - 1;
    const std::string end =
        others == 0 ? "." : ", and " + std::to_string(others) + " more like this.";
    return std::exchange(sentence_, {}) + end;
  }

 private:
  Time::duration interval_;
  Time next_ = Time::min();
  std::uint64_t count_ = 0;  // since take() gave one
  std::string sentence_;
};

}  // namespace ziggurat::network
