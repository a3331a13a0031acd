#include "wire/reset_commands.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <tuple>
#include <type_traits>
#include <utility>

namespace ziggurat::wire {

void reset_commands(const world::Layout& layout, std::size_t robot, world::Commands& commands) {
  world::for_each_channel(world::commanded, [&](auto i) {
    const auto& channel = std::get<i>(world::commanded);
    if (channel.released != world::Released::zeroed) return;
    auto& values = commands.*channel.values;
    const world::Range range = channel.devices(layout, layout.robots[robot]);
    std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(range.begin), range.count,
                typename std::decay_t<decltype(values)>::value_type{});
  });
  const world::Range& described = layout.robots[robot].device_commands;
  for (std::size_t i = described.begin; i < described.end(); ++i) {
    commands.device_commands[i] = layout.device_commands[i]->released;
  }
}

void forget_radio_messages(const Roster& roster, world::RadioMessages& messages) {
  if (messages.entries.empty()) return;
  const auto& pieces = roster.radios.stretches;  // ascending
  const auto is_own = [&](std::size_t radio) {
    const auto after = std::ranges::upper_bound(pieces, radio, {}, &Packing::Stretch::flat);
    if (after == pieces.begin()) return false;
    const Packing::Stretch& piece = *std::prev(after);
    if (radio >= piece.flat + piece.count) return false;
    return !roster.taken[roster.radios.owner(piece.packed + radio - piece.flat)];
  };
  world::RadioMessages others;  // without the bytes of those that are forgotten
  for (const world::RadioMessages::Entry& entry : messages.entries) {
    if (!is_own(entry.radio)) others.add(entry.radio, messages.payload(entry));
  }
  messages = std::move(others);
}

}  // namespace ziggurat::wire
