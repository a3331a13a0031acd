// SPDX-License-Identifier: MIT
// A director that ends the stacking scene when one block stands on the other, and reports how far
// aside it is:
//   ziggurat serve scenes/prototype_srocs_system.argos --allow-director --endpoint
//   tcp://127.0.0.1:7400 ZIGGURAT_ENDPOINT=tcp://127.0.0.1:7400 example_judge        and the
//   controllers of robot and blocks: ziggurat-lua --connect tcp://127.0.0.1:7400
// In a scene, <director id="judge" command="example_judge"/> starts it.

#include <ziggurat/ziggurat.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <optional>

namespace {

constexpr double block = 0.055;          // length of an edge [m]
constexpr double height = 0.002;         // how far from that the upper block's height may be [m]
constexpr double still = 0.001;          // a block that is slower is at rest [m/s]
constexpr std::chrono::seconds rest{1};  // simulated, for which it must stand

bool is_block(const ziggurat::Entity& entity) { return entity.id().starts_with("block"); }

bool is_still(const ziggurat::Entity& entity) {
  const auto& [x, y, z] = entity.links()[0].velocity;
  return std::hypot(x, y, z) < still;
}

/// Whether a robot touches a block: it may still hold it.
bool is_held(const ziggurat::Director& director) {
  return std::ranges::any_of(director.contacts(), [](const ziggurat::Contact& contact) {
    return contact.second != nullptr && is_block(*contact.first) != is_block(*contact.second);
  });
}

struct Stack {
  const ziggurat::Entity* lower;
  const ziggurat::Entity* upper;
  double aside;  // how far the upper one's centre is beside the lower one's [m]
};

/// The block that stands on another; nothing if there is none.
std::optional<Stack> find_stack(const ziggurat::Director& director) {
  for (const ziggurat::Entity* lower : director.entities()) {
    for (const ziggurat::Entity* upper : director.entities()) {
      if (!is_block(*lower) || !is_block(*upper)) continue;
      const auto& below = lower->pose().position;
      const auto& above = upper->pose().position;
      const double aside = std::hypot(above[0] - below[0], above[1] - below[1]);
      const bool stands = std::abs(above[2] - below[2] - block) < height && aside < block / 2;
      if (stands && is_still(*lower) && is_still(*upper)) return Stack{lower, upper, aside};
    }
  }
  return std::nullopt;
}

}  // namespace

int main() try {
  using Group = ziggurat::DirectorOptions::Group;
  auto options = ziggurat::DirectorOptions::from_environment();
  if (options.director.empty()) options.director = "judge";  // started by hand
  options.groups = {Group::poses, Group::links, Group::contacts};
  ziggurat::Director director(options);
  std::optional<std::chrono::nanoseconds> since;
  while (director.next()) {
    const auto stack = find_stack(director);
    if (!stack || is_held(director)) {
      since.reset();
      continue;
    }
    const std::chrono::nanoseconds began = since.value_or(director.time());
    since = began;
    if (director.time() - began < rest) continue;
    char text[200];
    std::snprintf(text, sizeof text, "%s stands on %s, %.2f mm aside", stack->upper->id().c_str(),
                  stack->lower->id().c_str(), 1000 * stack->aside);
    director.metric("aside_mm", 1000 * stack->aside);
    director.finish(text);
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "judge: %s\n", error.what());
  return 1;
}
