#include "wire/zero.h"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <type_traits>

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
  std::erase_if(messages.entries, [&](const world::RadioMessages::Entry& entry) {
    for (std::size_t i = 0; i < roster.radios.robots.size(); ++i) {
      const Packing::Stretch& radios = roster.radios.robots[i];
      const bool is_own = entry.radio >= radios.flat && entry.radio < radios.flat + radios.count;
      if (is_own) return !roster.taken[i];
    }
    return false;
  });
}

}  // namespace ziggurat::wire
