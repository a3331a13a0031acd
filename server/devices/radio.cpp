// SPDX-License-Identifier: MIT
// Radios: the messages of a step leave at the start of the next tick.

#include "media/radio.h"

#include <vector>

#include "devices/kind.h"

namespace ziggurat::devices {
namespace {

class Radios final : public Kind {
 public:
  std::unique_ptr<Kind> clone() const override { return std::make_unique<Radios>(*this); }

  void lay_out(const Carrier& carrier, world::RobotLayout& robot,
               world::Layout& layout) const override {
    robot.radios.begin = layout.radios.size();
    const auto& use = carrier.enabled.radios;
    if (!use) return;
    const scene::Devices& devices = carrier.entity.devices;
    robot.radios = append(devices.radios, layout.radios, [&](const scene::Radio& radio) {
      return world::RadioLayout{radio.id,      carrier.mount(radio.anchor, radio.position, layout),
                                radio.range,   devices.radio_medium.value_or(0),
                                use->actuator, use->sensor,
                                use->show_rays};
    });
  }

  void add(const Setting& setting) override {
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

  /// Delivers what was commanded and empties it; publishes the links of radios with `show_rays`.
  void apply(Tick& tick) override {
    world::RadioMessages& received = tick.observations.radio_messages;
    if (!needs_index_) {
      tick.commands.radio_messages.clear();
      return;
    }
    medium_.deliver(tick.layout, tick.index, tick.commands.radio_messages, received);
    for (const media::RadioLink& link : medium_.links()) {
      const bool is_asked_for = tick.layout.radios[link.sender].shows_links ||
                                tick.layout.radios[link.receiver].shows_links;
      tick.show({world::Ray::Kind::radio, robots_[link.receiver],
                 tick.index.position(tick.index.radios, link.sender),
                 tick.index.position(tick.index.radios, link.receiver)},
                {}, is_asked_for);
    }
  }

  bool needs_index() const override { return needs_index_; }

 private:
  media::RadioMedium medium_;
  std::vector<std::size_t> robots_;  // per radio, into Layout::robots
  bool needs_index_ = false;         // some radio sends and some radio receives
};

}  // namespace

std::unique_ptr<Kind> make_radios() { return std::make_unique<Radios>(); }

}  // namespace ziggurat::devices
