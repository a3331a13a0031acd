#include "wire/zero.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace ziggurat::wire {
namespace {

template <typename T>
void clear(std::vector<T>& values, const world::Range& range) {
  std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(range.begin), range.count, T{});
}

}  // namespace

void zero(const world::Layout& layout, std::size_t robot, world::Commands& commands) {
  const world::RobotLayout& of = layout.robots[robot];
  clear(commands.joint_targets, of.joint_actuators);
  clear(commands.magnet_currents, of.magnets);
  clear(commands.wheels, of.wheels);
  for (std::size_t i = of.turrets.begin; i < of.turrets.end(); ++i) commands.turrets[i].speed = 0;
  if (of.range_and_bearing.count == 0) return;
  const world::RangeAndBearingLayout& device = layout.range_and_bearing[of.range_and_bearing.begin];
  if (device.sends) clear(commands.range_and_bearing_data, device.data);
}

void forget_radio_messages(const Roster& roster, world::RadioMessages& messages) {
  std::erase_if(messages.entries, [&](const world::RadioMessages::Entry& entry) {
    return std::ranges::any_of(roster.radios.stretches, [&](const Packing::Stretch& radios) {
      return entry.radio >= radios.flat && entry.radio < radios.flat + radios.count;
    });
  });
}

}  // namespace ziggurat::wire
