#include "reports/progress.h"

#include <fmt/format.h>

namespace ziggurat::reports {
namespace {

constexpr std::chrono::milliseconds interval{200};

}  // namespace

bool Progress::needs_update() const {
  return console_.shows_progress() && clock::now() - shown_at_ >= interval;
}

void Progress::show(std::uint64_t tick, std::string_view waiting_for) {
  const auto now = clock::now();
  const double wall = std::chrono::duration<double>(now - shown_at_).count();
  const double rate = static_cast<double>(tick - shown_tick_) / wall;
  console_.progress(fmt::format("t = {:.2f} s, real-time factor {:.2f}, {:.0f} ticks/s{}{}",
                                static_cast<double>(tick) * tick_length_, rate * tick_length_, rate,
                                waiting_for.empty() ? "" : ", waiting for ", waiting_for));
  shown_at_ = now;
  shown_tick_ = tick;
}

}  // namespace ziggurat::reports
