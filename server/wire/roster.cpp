#include "wire/roster.h"

namespace ziggurat::wire {

void Packing::append(const world::Range& flat) {
  const Stretch robot{count, flat.begin, flat.count};
  robots.push_back(robot);
  count += flat.count;
  if (flat.count == 0) return;
  if (!stretches.empty() && stretches.back().flat + stretches.back().count == flat.begin) {
    stretches.back().count += flat.count;
  } else {
    stretches.push_back(robot);
  }
}

void Roster::leave(std::size_t position) {
  if (gone[position]) return;
  gone[position] = true;
  ++gone_count;
}

Roster make_roster(const world::Layout& layout, std::span<const std::size_t> robots) {
  Roster roster;
  roster.robots.assign(robots.begin(), robots.end());
  roster.gone.assign(robots.size(), false);
  for (const std::size_t robot : robots) {
    roster.joint_sensors.append(layout.robots[robot].joint_sensors);
    roster.joint_actuators.append(layout.robots[robot].joint_actuators);
  }
  return roster;
}

}  // namespace ziggurat::wire
