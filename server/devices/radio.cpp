#include "devices/radio.h"

namespace ziggurat::devices {

void Radios::add(const Setting& setting) {
  const world::Layout& layout = setting.layout;
  robots_.resize(layout.radios.size());
  for (std::size_t r = 0; r < layout.robots.size(); ++r) {
    const world::Range& radios = layout.robots[r].radios;
    for (std::size_t i = radios.begin; i < radios.end(); ++i) robots_[i] = r;
  }
  bool send = false, receive = false;
  for (const world::RadioLayout& radio : layout.radios) {
    send = send || radio.sends;
    receive = receive || radio.receives;
  }
  needs_index_ = send && receive;
}

void Radios::apply(Tick& tick) {
  world::RadioMessages& received = tick.observations.radio_messages;
  if (!needs_index_) {
    tick.commands.radio_messages.clear();
    return;
  }
  medium_.deliver(tick.layout, tick.index, tick.commands.radio_messages, received);
  for (const media::RadioLink& link : medium_.links()) {
    if (!tick.layout.radios[link.sender].shows_links &&
        !tick.layout.radios[link.receiver].shows_links) {
      continue;
    }
    tick.state.rays.push_back({world::Ray::Kind::radio, robots_[link.receiver],
                               tick.index.position(tick.index.radios, link.sender),
                               tick.index.position(tick.index.radios, link.receiver), false});
  }
}

}  // namespace ziggurat::devices
