#include "wire/zero.h"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

namespace ziggurat::wire {

void zero(const world::Layout& layout, std::size_t robot, world::Commands& commands) {
  world::for_each_channel(world::commanded, [&](auto i) {
    const auto& channel = std::get<i>(world::commanded);
    if (channel.released == world::Released::kept) return;
    auto& values = commands.*channel.values;
    const world::Range range = channel.devices(layout, layout.robots[robot]);
    std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(range.begin), range.count,
                typename std::decay_t<decltype(values)>::value_type{});
  });
}

void forget_radio_messages(const Roster& roster, world::RadioMessages& messages) {
  if (messages.entries.empty()) return;
  const auto is_own = [&](std::size_t radio) {
    for (std::size_t i = 0; i < roster.radios.robots.size(); ++i) {
      const Packing::Stretch& radios = roster.radios.robots[i];
      if (radio >= radios.flat && radio < radios.flat + radios.count) return !roster.taken[i];
    }
    return false;
  };
  world::RadioMessages others;  // without the bytes of those that are forgotten
  for (const world::RadioMessages::Entry& entry : messages.entries) {
    if (!is_own(entry.radio)) others.add(entry.radio, messages.payload(entry));
  }
  messages = std::move(others);
}

}  // namespace ziggurat::wire
