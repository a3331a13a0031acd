#include "channels/robots.h"

#include "channels/packing.h"
#include "wire/devices.h"
#include "wire/observation.h"

namespace ziggurat::channels {

void fill(const wire::Roster& robot, const Moment& moment, v1::Observation& to) {
  to.Clear();
  wire::fill(robot, moment.observations, moment.state.tag_payloads, to);
}

void fill(const wire::Roster& robot, const world::Layout& layout, const Moment& moment,
          v1::Command& command) {
  command.Clear();
  command.set_tick(moment.state.tick);
  wire::add_channels(robot, moment.commands, command);
  const world::Range& radios = layout.robots[robot.robots.front()].radios;
  const world::RadioMessages& sent = moment.commands.radio_messages;
  for (const auto& entry : sent.entries) {
    if (entry.radio < radios.begin || entry.radio >= radios.end()) continue;
    v1::RadioMessage& message = *command.add_radio_messages();
    message.set_radio(index(entry.radio - radios.begin));
    const auto payload = sent.payload(entry);
    message.set_payload(payload.data(), payload.size());
  }
}

}  // namespace ziggurat::channels
