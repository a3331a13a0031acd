// SPDX-License-Identifier: MIT
// Visible state of robots: LEDs, directional LEDs, tags, magnets, and the data that
// range-and-bearing devices send. Commands of tick k are in State k + 1.

#include "devices/kind.h"

namespace ziggurat::devices {
namespace {

world::Color packed(const scene::Color& color) {
  return (world::Color{color.red} << 16) | (world::Color{color.green} << 8) | color.blue;
}

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

class Visible final : public Kind {
 public:
  std::unique_ptr<Kind> clone() const override { return std::make_unique<Visible>(*this); }

  void lay_out(const Carrier& carrier, world::RobotLayout& robot,
               world::Layout& layout) const override {
    const scene::Devices& carried = carrier.entity.devices;
    const scene::ControllerDevices& enabled = carrier.enabled;
    const scene::LedsUse leds = enabled.leds.value_or(scene::LedsUse{});
    const std::size_t led_medium = leds.medium.value_or(carried.led_medium.value_or(0));
    // Others perceive them, whether a controller sets them or not.
    const auto set_if = [](bool is_enabled, const world::Range& all) {
      return world::Range{all.begin, is_enabled ? all.count : 0};
    };
    world::EntityLayout& entity = layout.entities[carrier.index];
    entity.leds = append(carried.leds, layout.leds, [&](const scene::Led& led) {
      return world::LedLayout{led.id, carrier.mount(led.anchor, led.offset, layout), led_medium,
                              packed(led.color)};
    });
    entity.directional_leds =
        append(carried.directional_leds, layout.directional_leds, [&](const auto& led) {
          return world::DirectionalLedLayout{led.id, carrier.mount(led.anchor, led.pose, layout),
                                             carried.directional_led_medium.value_or(0),
                                             led.observable_angle, packed(led.color)};
        });
    entity.tags = append(carried.tags, layout.tags, [&](const scene::Tag& tag) {
      return world::TagLayout{tag.id,
                              carrier.mount(tag.anchor, tag.pose, layout),
                              carried.tag_medium.value_or(0),
                              tag.observable_angle,
                              tag.side_length,
                              tag.payload};
    });
    const world::Range magnets =
        append(carried.magnets, layout.magnets, [&](const scene::Magnet& magnet) {
          return world::MagnetLayout{magnet.id, carrier.mount(magnet.anchor, magnet.offset, layout),
                                     magnet.passive_field, magnet.active_field};
        });
    robot.leds = set_if(enabled.leds.has_value(), entity.leds);
    robot.directional_leds = set_if(enabled.directional_leds, entity.directional_leds);
    robot.tags = set_if(enabled.tags, entity.tags);
    robot.magnets = set_if(enabled.magnets, magnets);
  }

  /// New devices show what the scene says.
  void start(Tick& tick) override {
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

  void apply(Tick& tick) override {
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
};

}  // namespace

std::unique_ptr<Kind> make_visible() { return std::make_unique<Visible>(); }

}  // namespace ziggurat::devices
