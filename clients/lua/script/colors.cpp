// SPDX-License-Identifier: MIT
#include "script/colors.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "script/trimmed.h"

namespace ziggurat::lua {
namespace {

// The same as in docs/scene-format.md.
constexpr std::array<std::pair<std::string_view, Color>, 20> named_colors{{
    {"black", {0, 0, 0}},        {"white", {255, 255, 255}},  {"red", {255, 0, 0}},
    {"green", {0, 255, 0}},      {"blue", {0, 0, 255}},       {"magenta", {255, 0, 255}},
    {"cyan", {0, 255, 255}},     {"yellow", {255, 255, 0}},   {"orange", {255, 140, 0}},
    {"brown", {165, 42, 42}},    {"purple", {160, 32, 240}},  {"gray10", {26, 26, 26}},
    {"gray20", {51, 51, 51}},    {"gray30", {77, 77, 77}},    {"gray40", {102, 102, 102}},
    {"gray50", {127, 127, 127}}, {"gray60", {153, 153, 153}}, {"gray70", {179, 179, 179}},
    {"gray80", {204, 204, 204}}, {"gray90", {229, 229, 229}},
}};

std::optional<std::uint8_t> parse_channel(std::string_view text) {
  text = trimmed(text);
  std::uint8_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::optional<Color> parse_color(std::string_view text) {
  for (const auto& [name, color] : named_colors) {
    if (name == trimmed(text)) return color;
  }
  std::array<std::uint8_t, 4> channels{};
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const std::size_t end = i + 1 < channels.size() ? text.find(',') : text.size();
    if (end == std::string_view::npos) return std::nullopt;
    const auto channel = parse_channel(text.substr(0, end));
    if (!channel) return std::nullopt;
    channels[i] = *channel;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return Color{channels[0], channels[1], channels[2]};
}

}  // namespace ziggurat::lua
