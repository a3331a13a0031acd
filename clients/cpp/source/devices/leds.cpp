// SPDX-License-Identifier: MIT
// LEDs and directional LEDs.

#include "layout.h"

namespace ziggurat {

void Layout::add_leds() {
  auto& colors = add(Settings<std::uint32_t>(&v1::Command::mutable_led_colors));
  auto& directional = add(Settings<std::uint32_t>(&v1::Command::mutable_directional_led_colors));
  const auto add_to = [](std::vector<Led>& leds, const v1::LedDescription& from,
                         Settings<std::uint32_t>& settings) {
    Led& led = leds.emplace_back();
    led.id_ = from.id();
    led.color_ = &settings.add(from.color());
    led.changed_ = &settings.changed();
  };
  each_robot([&](const v1::RobotDescription& from, Robot& to) {
    for (const auto& led : from.leds()) add_to(to.leds_, led, colors);
    for (const auto& led : from.directional_leds()) add_to(to.directional_leds_, led, directional);
  });
}

void Led::set_color(Color color) noexcept {
  *color_ = static_cast<std::uint32_t>(color.red) << 16 |
            static_cast<std::uint32_t>(color.green) << 8 | color.blue;
  *changed_ = true;
}

Color Led::color() const noexcept { return color_of(*color_); }

}  // namespace ziggurat
