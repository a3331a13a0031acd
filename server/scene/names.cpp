// SPDX-License-Identifier: MIT
#include "scene/names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "scene/values.h"
#include "text/names.h"

namespace ziggurat::scene {
namespace {

constexpr std::size_t longest_compared = 64;  // characters of a name

using Reason = std::pair<std::string_view, std::string_view>;
using Reasons = std::span<const Reason>;

constexpr auto element_reasons = std::to_array<Reason>({
    {"loop_functions", "write <director id=\"…\" script=\"…\"/> under the root"},
    {"quadrotor", "write <mini-quadrotor>, <spiri> or <eye-bot>"},
    {"khepera", "write <kheperaiv>"},
    {"e-puck2", "write <e-puck>"},
    {"crazyflie", "write <mini-quadrotor>"},
    {"thymio", "write <e-puck>, or model it as a <prototype>"},
    {"pi-puck", "write <pipuck>"},
    {"drone", "write <spiri> with <quadrotor_position> or <quadrotor_speed>"},
    {"srocs", "use <magnetism>"},
    {"simple_radio", "use <radio>"},
    {"simple_radios", "use <radios>"},
    {"boundaries", "the world is one and unbounded; remove it"},
});

constexpr auto homes = std::to_array<Reason>({
    {"experiment", "framework"},
    {"run", "framework"},
    {"lua_controller", "controllers"},
    {"external_controller", "controllers"},
    {"dynamics3d", "physics_engines"},
    {"gravity", "dynamics3d"},
    {"magnetism", "dynamics3d"},
    {"prototype", "arena"},
    {"foot-bot", "arena"},
    {"e-puck", "arena"},
    {"eye-bot", "arena"},
    {"spiri", "arena"},
    {"mini-quadrotor", "arena"},
    {"kilobot", "arena"},
    {"pipuck", "arena"},
    {"builderbot", "arena"},
    {"kheperaiv", "arena"},
    {"block", "arena"},
    {"link", "links"},
    {"joint", "joints"},
    {"parent", "joint"},
    {"child", "joint"},
    {"devices", "prototype"},
    {"led", "leds"},
    {"tag", "tags"},
    {"radio", "radios"},
    {"magnet", "magnets"},
    {"camera", "cameras"},
});

constexpr auto attribute_homes = std::to_array<Reason>({
    {"mass", "link"},
    {"geometry", "link"},
    {"friction", "link"},
    {"restitution", "link"},
});

/// Beginnings of the names of their devices.
constexpr auto foreign_robots = std::to_array<Reason>({
    {"epuck_", "e-puck of another plug-in"},
    {"epuck2_", "e-puck2"},
    {"drone_", "drone"},
    {"kheperaiv_", "kheperaiv of another plug-in"},
    {"crazyflie_", "crazyflie"},
    {"thymio_", "thymio"},
});

std::optional<std::string_view> reason(std::string_view name, Reasons reasons) {
  for (const auto& [known, why] : reasons) {
    if (known == name) return why;
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string_view> nearest(std::string_view name,
                                        std::span<const std::string_view> candidates) {
  if (name.size() > longest_compared) return std::nullopt;
  std::optional<std::string_view> best;
  std::size_t least = std::max<std::size_t>(1, name.size() / 3) + 1;
  for (const std::string_view candidate :
       candidates.first(std::min(most_compared, candidates.size()))) {
    if (candidate.size() > longest_compared) continue;
    const std::size_t distance = text::edit_distance(name, candidate);
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

std::string advice(std::string_view name, std::span<const std::string_view> candidates) {
  const auto meant = nearest(name, candidates);
  return meant ? fmt::format("did you mean {}?", in_quotes(*meant)) : list_known(candidates);
}

std::string list_known(std::span<const std::string_view> candidates) {
  constexpr std::size_t most_listed = 12;
  if (candidates.empty()) return "none is known here";
  std::vector<std::string_view> listed;
  for (const std::string_view candidate : candidates) {
    if (std::ranges::find(listed, candidate) != listed.end()) continue;
    listed.push_back(candidate);
    if (listed.size() > most_listed) break;
  }
  std::string list;
  for (const std::string_view each :
       std::span(listed).first(std::min(most_listed, listed.size()))) {
    list += (list.empty() ? "" : ", ") + std::string(each.substr(0, longest_compared));
  }
  return fmt::format("known here: {}{}", list, listed.size() > most_listed ? ", …" : "");
}

std::string advice(std::string_view name, const std::vector<std::string>& candidates) {
  const std::vector<std::string_view> views(candidates.begin(), candidates.end());
  return advice(name, std::span<const std::string_view>(views));
}

std::string Ids::next(std::string_view stem, Location where) {
  for (;; ++lowest_) {
    std::string id = fmt::format("{}_{}", stem, lowest_);
    if (add(id, where)) return id;
  }
}

std::optional<std::string_view> home_of(std::string_view element) { return reason(element, homes); }

std::optional<std::string_view> robot_of_device(std::string_view name) {
  for (const auto& [prefix, robot] : foreign_robots) {
    if (name.starts_with(prefix)) return robot;
  }
  return std::nullopt;
}

std::optional<std::string_view> home_of_attribute(std::string_view attribute) {
  return reason(attribute, attribute_homes);
}

std::optional<std::string_view> unsupported_element(std::string_view name) {
  return reason(name, element_reasons);
}

}  // namespace ziggurat::scene
