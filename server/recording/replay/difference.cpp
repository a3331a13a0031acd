#include "recording/replay/difference.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string_view>

namespace ziggurat::replay {
namespace {

constexpr std::array<std::string_view, 13> field_names{
    "position.x",        "position.y",    "position.z",         "orientation.w",
    "orientation.x",     "orientation.y", "orientation.z",      "velocity.x",
    "velocity.y",        "velocity.z",    "angular_velocity.x", "angular_velocity.y",
    "angular_velocity.z"};

std::array<double, 13> values_of(const world::LinkState& link) {
  std::array<double, 13> values{};
  const auto pose = world::numbers(link.pose);
  std::copy(pose.begin(), pose.end(), values.begin());
  std::copy_n(link.velocity.data(), 3, values.begin() + 7);
  std::copy_n(link.angular_velocity.data(), 3, values.begin() + 10);
  return values;
}

}  // namespace

std::optional<Difference> first_difference(std::span<const world::LinkState> a,
                                           std::span<const world::LinkState> b) {
  for (std::size_t link = 0; link < std::min(a.size(), b.size()); ++link) {
    const auto of_a = values_of(a[link]), of_b = values_of(b[link]);
    for (std::size_t i = 0; i < field_names.size(); ++i) {
      if (std::bit_cast<std::uint64_t>(of_a[i]) == std::bit_cast<std::uint64_t>(of_b[i])) continue;
      return Difference{link, std::string(field_names[i]), of_a[i], of_b[i]};
    }
  }
  return std::nullopt;
}

Distance distance(std::span<const world::LinkState> a, std::span<const world::LinkState> b) {
  Distance result;
  const std::size_t count = std::min(a.size(), b.size());
  for (std::size_t link = 0; link < count; ++link) {
    const double apart = (a[link].pose.position - b[link].pose.position).norm();
    result.mean += apart / static_cast<double>(count);
    result.angle =
        std::max(result.angle, a[link].pose.orientation.angularDistance(b[link].pose.orientation));
    if (apart <= result.greatest) continue;
    result.greatest = apart;
    result.link = link;
  }
  return result;
}

}  // namespace ziggurat::replay
