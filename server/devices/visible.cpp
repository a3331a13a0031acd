#include "devices/visible.h"

namespace ziggurat::devices {

void start_visible(Tick& tick) {
  world::Commands& commands = tick.commands;
  commands.led_colors.clear();
  commands.directional_led_colors.clear();
  commands.tag_payloads.clear();
  for (const auto& led : tick.layout.leds) commands.led_colors.push_back(led.color);
  for (const auto& led : tick.layout.directional_leds) {
    commands.directional_led_colors.push_back(led.color);
  }
  for (const auto& tag : tick.layout.tags) commands.tag_payloads.push_back(tag.payload);
  commands.magnet_currents.assign(tick.layout.magnets.size(), 0);
  const auto& senders = tick.layout.range_and_bearing;
  commands.range_and_bearing_data.assign(senders.empty() ? 0 : senders.back().data.end(), 0);
  apply_visible(tick);
}

void apply_visible(Tick& tick) {
  const world::Commands& commands = tick.commands;
  tick.state.led_colors = commands.led_colors;
  tick.state.directional_led_colors = commands.directional_led_colors;
  tick.state.tag_payloads = commands.tag_payloads;
  tick.state.range_and_bearing_data = commands.range_and_bearing_data;
  const std::vector<world::MagnetLayout>& magnets = tick.layout.magnets;
  tick.physics.set_currents(commands.magnet_currents);
  tick.state.magnet_fields.resize(magnets.size());
  for (std::size_t i = 0; i < magnets.size(); ++i) {
    tick.state.magnet_fields[i] =
        magnets[i].passive_field + commands.magnet_currents[i] * magnets[i].active_field;
  }
}

}  // namespace ziggurat::devices
