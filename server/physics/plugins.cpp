// SPDX-License-Identifier: MIT
#include "physics/plugins.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "physics/contact_sensing.h"
#include "physics/core.h"
#include "physics/flight.h"
#include "physics/forces.h"
#include "physics/magnets.h"
#include "physics/wheels.h"

namespace ziggurat::physics {
namespace {

using Made = std::unique_ptr<Plugin>;

template <class Kind, class... Arguments>
Made make(Arguments&&... arguments) {
  return std::make_unique<Kind>(std::forward<Arguments>(arguments)...);
}

/// The plug-ins, in the order in which they act. The first ones are chosen by their tag in
/// <dynamics3d>, which scene/engines.cpp reads; a new plug-in is a line here.
constexpr std::array choices{
    +[](const scene::Physics&) { return make<ViscousDamping>(); },
    +[](const scene::Physics& p) { return p.magnetism ? make<Magnets>(*p.magnetism) : nullptr; },
    +[](const scene::Physics&) { return make<Wheels>(); },
    +[](const scene::Physics&) { return make<Flight>(); },
    +[](const scene::Physics&) { return make<ContactSensing>(); },
};

auto sides(const LinkContact& contact) { return std::tie(contact.a, contact.b); }

}  // namespace

Plugins::Plugins(const scene::Physics& physics, NewtonCore& core) {
  if (physics.floor) core.add_floor(physics.floor->surface);
  for (const auto choose : choices) {
    if (Made plugin = choose(physics)) plugins_.push_back(std::move(plugin));
  }
}

void Plugins::add(std::unique_ptr<Plugin> plugin) { plugins_.push_back(std::move(plugin)); }

void Plugins::add(Body& body) {
  for (auto& plugin : plugins_) plugin->body_added(body);
}

void Plugins::remove(const Body& body) {
  for (auto& plugin : plugins_) plugin->body_removed(body);
}

void Plugins::move(Body& body) {
  for (auto& plugin : plugins_) plugin->body_moved(body);
}

void Plugins::watch(const Body& body) {
  for (auto& plugin : plugins_) plugin->body_watched(body);
}

void Plugins::before_substep(std::span<Body> bodies, double substep, timing::Stopwatch* watch) {
  for (auto& plugin : plugins_) {
    enter(watch, plugin->phase());
    plugin->before_substep(bodies, substep);
  }
}

Plugin* Plugins::stiff() const {
  for (auto& plugin : plugins_) {
    if (!plugin->stiff_pairs().empty()) return plugin.get();
  }
  return nullptr;
}

void Plugins::after_substep(std::span<Body> bodies, double substep, const NewtonCore& core) {
  std::swap(before_, now_);
  now_.clear();
  const bool wanted = std::ranges::any_of(
      plugins_, [&](const auto& plugin) { return plugin->wants_contacts(bodies); });
  if (wanted) core.contacts(now_);
  if (!now_.empty() || !before_.empty()) tell_contacts(bodies);
  for (auto& plugin : plugins_) plugin->after_substep(bodies, substep);
}

void Plugins::tell_contacts(std::span<Body> bodies) {
  for (auto& plugin : plugins_) {
    if (!plugin->wants_contacts(bodies)) continue;
    auto before = before_.begin();
    for (const LinkContact& contact : now_) {
      while (before != before_.end() && sides(*before) < sides(contact)) ++before;
      const bool known = before != before_.end() && sides(*before) == sides(contact);
      known ? plugin->contact_persists(bodies, contact) : plugin->contact_begins(bodies, contact);
    }
    auto now = now_.begin();
    for (const LinkContact& contact : before_) {
      while (now != now_.end() && sides(*now) < sides(contact)) ++now;
      if (now == now_.end() || sides(contact) != sides(*now)) plugin->contact_ends(bodies, contact);
    }
  }
}

}  // namespace ziggurat::physics
