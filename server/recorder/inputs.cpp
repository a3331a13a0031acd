#include "recorder/inputs.h"

#include <cstring>
#include <type_traits>
#include <vector>

namespace ziggurat::recorder {
namespace {

template <class T>
bool is_same(const std::vector<T>& a, const std::vector<T>& b) {
  if constexpr (std::is_trivially_copyable_v<T>) {
    const std::size_t size = a.size() * sizeof(T);
    return a.size() == b.size() && (size == 0 || std::memcmp(a.data(), b.data(), size) == 0);
  } else {
    return a == b;
  }
}

using Numbers = v1::Commands::Numbers;
using Integers = v1::Commands::Integers;

void fill(const std::vector<double>& from, Numbers& to) {
  to.mutable_values()->Add(from.begin(), from.end());
}
void fill(const std::vector<world::WheelsCommand>& from, Numbers& to) {
  for (const auto& [left, right] : from) {
    to.add_values(left);
    to.add_values(right);
  }
}
template <class T>
void fill(const std::vector<T>& from, Integers& to) {
  for (const T value : from) to.add_values(static_cast<std::uint32_t>(value));
}

}  // namespace

void CommandChanges::fill(const world::Commands& from, v1::Commands& to) {
  const auto write = [&](auto field, const auto& add) {
    if (!is_first_ && is_same(from.*field, before_.*field)) return;
    add(from.*field);
    before_.*field = from.*field;
  };
  using world::Commands;
  using recorder::fill;
  write(&Commands::joint_targets, [&](const auto& all) { fill(all, *to.mutable_joint_targets()); });
  write(&Commands::led_colors, [&](const auto& all) { fill(all, *to.mutable_led_colors()); });
  write(&Commands::directional_led_colors,
        [&](const auto& all) { fill(all, *to.mutable_directional_led_colors()); });
  write(&Commands::tag_payloads, [&](const auto& all) {
    for (const std::string& each : all) to.mutable_tag_payloads()->add_values(each);
    to.mutable_tag_payloads();
  });
  write(&Commands::magnet_currents,
        [&](const auto& all) { fill(all, *to.mutable_magnet_currents()); });
  write(&Commands::range_and_bearing_data,
        [&](const auto& all) { to.set_range_and_bearing_data(all.data(), all.size()); });
  write(&Commands::wheels, [&](const auto& all) { fill(all, *to.mutable_wheels()); });
  write(&Commands::turret_modes, [&](const auto& all) { fill(all, *to.mutable_turret_modes()); });
  write(&Commands::turret_rotations,
        [&](const auto& all) { fill(all, *to.mutable_turret_rotations()); });
  write(&Commands::turret_speeds, [&](const auto& all) { fill(all, *to.mutable_turret_speeds()); });
  static_assert(std::tuple_size_v<decltype(world::commanded)> == 11, "write new fields here, too");
  for (const auto& entry : from.radio_messages.entries) {
    v1::Commands::RadioMessage& message = *to.add_radio_messages();
    message.set_radio(static_cast<std::uint32_t>(entry.radio));
    const auto payload = from.radio_messages.payload(entry);
    message.set_payload(payload.data(), payload.size());
  }
  is_first_ = false;
}

}  // namespace ziggurat::recorder
