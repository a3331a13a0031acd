#include "devices/visible.h"

namespace ziggurat::devices {
namespace {

math::Vector3 field_of(const world::MagnetLayout& magnet, double current) {
  return magnet.passive_field + current * magnet.active_field;
}

/// Gives the devices that are new in the list their first value, in what is commanded and shown.
template <class Device, class Value, class Get>
void start_all(const std::vector<Device>& devices, std::vector<Value>& commanded,
               std::vector<Value>& shown, Get first) {
  for (std::size_t i = commanded.size(); i < devices.size(); ++i) {
    commanded.push_back(first(devices[i]));
    shown.push_back(commanded.back());
  }
}

}  // namespace

void start_visible(Tick& tick) {
  world::Commands& commands = tick.commands;
  world::State& state = tick.state;
  const auto color = [](const auto& led) { return led.color; };
  start_all(tick.layout.leds, commands.led_colors, state.led_colors, color);
  start_all(tick.layout.directional_leds, commands.directional_led_colors,
            state.directional_led_colors, color);
  start_all(tick.layout.tags, commands.tag_payloads, state.tag_payloads,
            [](const world::TagLayout& tag) { return tag.payload; });
  for (std::size_t i = state.magnet_fields.size(); i < tick.layout.magnets.size(); ++i) {
    commands.magnet_currents.push_back(0);
    state.magnet_fields.push_back(field_of(tick.layout.magnets[i], 0));
  }
  const auto& senders = tick.layout.range_and_bearing;
  const std::size_t bytes = senders.empty() ? 0 : senders.back().data.end();
  commands.range_and_bearing_data.resize(bytes, 0);
  state.range_and_bearing_data.resize(bytes, 0);
}

void apply_visible(Tick& tick) {
  const world::Commands& commands = tick.commands;
  tick.state.led_colors = commands.led_colors;
  tick.state.directional_led_colors = commands.directional_led_colors;
  tick.state.tag_payloads = commands.tag_payloads;
  tick.state.range_and_bearing_data = commands.range_and_bearing_data;
  const std::vector<world::MagnetLayout>& magnets = tick.layout.magnets;
  tick.physics.set_currents(commands.magnet_currents);
  for (std::size_t i = 0; i < magnets.size(); ++i) {
    tick.state.magnet_fields[i] = field_of(magnets[i], commands.magnet_currents[i]);
  }
}

}  // namespace ziggurat::devices
