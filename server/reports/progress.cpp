// SPDX-License-Identifier: MIT
#include "reports/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "text/numbers.h"

namespace ziggurat::reports {
namespace {

constexpr std::chrono::milliseconds interval{200};
constexpr double memory_s = 3;  // of the rate that the time left is computed with

}  // namespace

bool Progress::needs_update() const {
  return console_.shows_progress() && clock::now() - shown_at_ >= interval;
}

void Progress::show(std::uint64_t tick, std::string_view waiting_for) {
  const auto now = clock::now();
  const double wall = std::chrono::duration<double>(now - shown_at_).count();
  const bool was_reset = tick < shown_tick_;
  const double rate = was_reset ? 0 : static_cast<double>(tick - shown_tick_) / wall;
  const double weight = usual_rate_ == 0 ? 1 : 1 - std::exp(-wall / memory_s);
  usual_rate_ += weight * (rate - usual_rate_);
  console_.progress(progress_line({tick, ticks_, tick_length_, rate, usual_rate_}, waiting_for));
  shown_at_ = now;
  shown_tick_ = tick;
}

std::string reached(std::uint64_t tick, std::optional<std::uint64_t> ticks, double tick_length,
                    double rate) {
  const double time = static_cast<double>(tick) * tick_length;
  if (!ticks || *ticks == 0) return fmt::format("t = {:.2f} s", time);
  const double share = static_cast<double>(tick) / static_cast<double>(*ticks);
  std::string text =
      fmt::format("t = {:.2f} of {:.2f} s ({:.0f} %)", time,
                  static_cast<double>(*ticks) * tick_length, std::floor(100 * share));
  if (rate > 0 && tick <= *ticks) {
    text += fmt::format(", {} left", text::to_duration(static_cast<double>(*ticks - tick) / rate));
  }
  return text;
}

std::string progress_line(const Speed& at, std::string_view waiting_for) {
  if (!waiting_for.empty()) {
    return fmt::format("{}, waiting for {}", reached(at.tick, at.ticks, at.tick_length, 0),
                       waiting_for);
  }
  return fmt::format("{}, real-time factor {:.2f}, {:.0f} ticks/s",
                     reached(at.tick, at.ticks, at.tick_length, at.usual_rate),
                     at.rate * at.tick_length, at.rate);
}

}  // namespace ziggurat::reports
