// SPDX-License-Identifier: MIT
#include "run/radio_watch.h"

#include <fmt/format.h>

#include <map>

#include "world/limits.h"

namespace ziggurat::run {
namespace {

constexpr std::uint64_t fewest_ticks = 10;  // before anything is said

}  // namespace

RadioWatch::Radio& RadioWatch::at(std::size_t radio) {
  if (radio >= radios_.size()) radios_.resize(radio + 1);
  return radios_[radio];
}

void RadioWatch::tick(const world::Observations& observations, const world::Commands& commands) {
  ++ticks_;
  const std::uint64_t left_out = observations.radio_messages.left_out;
  if (left_out > 0 && left_out_ == 0) first_left_out_ = observations.tick;
  left_out_ += left_out;
  for (const auto& message : observations.radio_messages.entries) {
    at(message.radio).has_received = true;
  }
  for (const auto& message : commands.radio_messages.entries) {
    Radio& radio = at(message.radio);
    if (radio.last_sent == ticks_) continue;
    radio.last_sent = ticks_;
    ++radio.sent;
  }
}

std::string RadioWatch::warning(const world::Layout& layout) const {
  const std::string left_out = of_left_out(), deaf = of_deaf(layout);
  return left_out + (left_out.empty() || deaf.empty() ? "" : "; ") + deaf;
}

std::string RadioWatch::of_left_out() const {
  if (left_out_ == 0) return {};
  return fmt::format(
      "from tick {} on, {} radio messages were not received: all radios together receive at most "
      "{} at a tick, "
      "and of more the last ones of those that send most are left out; send fewer, or write a "
      "smaller range",
      first_left_out_, left_out_, world::most_received_messages);
}

std::string RadioWatch::of_deaf(const world::Layout& layout) const {
  if (ticks_ < fewest_ticks) return {};
  std::map<std::size_t, std::size_t> senders;  // by medium
  for (std::size_t r = 0; r < radios_.size() && r < layout.radios.size(); ++r) {
    if (radios_[r].sent > 0) ++senders[layout.radios[r].medium];
  }
  std::string first;
  std::size_t count = 0;
  for (std::size_t r = 0; r < radios_.size() && r < layout.radios.size(); ++r) {
    const world::RadioLayout& radio = layout.radios[r];
    const bool is_deaf =
        radio.receives && !radios_[r].has_received && radios_[r].sent + 1 >= ticks_;
    if (!is_deaf || senders[radio.medium] < 2) continue;
    if (++count == 1) {
      first = fmt::format("radio '{}' of '{}'", radio.id, layout.entities[radio.mount.entity].id);
    }
  }
  if (count == 0) return {};
  return fmt::format(
      "{}{} sent at every tick and so heard nothing: a radio that sends in a tick "
      "receives nothing in it; send at some ticks only",
      first, count == 1 ? "" : fmt::format(" and {} more", count - 1));
}

}  // namespace ziggurat::run
