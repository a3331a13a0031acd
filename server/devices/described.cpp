// SPDX-License-Identifier: MIT
#include "devices/described.h"

#include <algorithm>
#include <iterator>
#include <string>

#include "math/archive.h"

namespace ziggurat::devices {
namespace {

/// Extends a robot's range by values that are appended now.
world::Range extend(world::Range& of_robot, std::size_t begin, std::size_t count) {
  if (of_robot.count == 0) of_robot.begin = begin;
  of_robot.count += count;
  return {begin, count};
}

}  // namespace

void Described::lay_out(const Carrier& carrier, world::RobotLayout& robot,
                        world::Layout& layout) const {
  const auto& uses = carrier.enabled.described;
  const auto use = std::ranges::find(uses, kind_.name, &scene::DescribedUse::kind);
  if (use == uses.end()) return;
  for (const scene::DevicePlace& place : carrier.entity.devices.places) {
    if (place.name != use->places) continue;
    extend(robot.described, layout.described.size(), 1);
    world::DescribedDevice& device = layout.described.emplace_back();
    device.kind = &kind_;
    device.mount = carrier.mount(place.anchor, place.pose, layout);
    device.properties = properties(place);
    device.sight = sight(place);
    const bool reads_rows = use->sensor && kind_.is_list();
    const std::size_t values = use->sensor && !kind_.is_list() ? kind_.readings.size() : 0;
    device.readings = extend(robot.device_readings, layout.device_readings, values);
    device.rows = extend(robot.device_lists, layout.device_lists, reads_rows ? 1 : 0);
    layout.device_readings += device.readings.count;
    layout.device_lists += device.rows.count;
    device.commands = extend(robot.device_commands, layout.device_commands.size(),
                             use->actuator ? kind_.commands.size() : 0);
    for (const world::DeviceCommand& command : kind_.commands) {
      if (use->actuator) layout.device_commands.push_back(&command);
    }
  }
}

void Described::add(const Setting& setting) {
  add_others(setting);
  for (std::size_t r = setting.first_robot; r < setting.layout.robots.size(); ++r) {
    const world::RobotLayout& layout = setting.layout.robots[r];
    world::Range devices;
    for (std::size_t i = layout.described.begin; i < layout.described.end(); ++i) {
      if (setting.layout.described[i].kind == &kind_) extend(devices, i, 1);
    }
    if (devices.count == 0) continue;
    const auto& uses = setting.enabled(layout).described;
    const auto use = std::ranges::find(uses, kind_.name, &scene::DescribedUse::kind);
    std::vector<scene::DevicePlace> places;
    std::ranges::copy_if(setting.entity(layout.entity).devices.places, std::back_inserter(places),
                         [&](const auto& place) { return place.name == use->places; });
    robots_.push_back(
        {r, devices, std::move(places), *use,
         math::RandomStream(setting.seed, std::string(kind_.name) + "/" + layout.id)});
    add_robot(setting);
  }
}

/// New devices read 0, and no rows.
void Described::start(Tick& tick) {
  const world::Layout& layout = tick.layout;
  tick.observations.device_readings.resize(layout.device_readings, 0);
  tick.observations.device_rows.resize(layout.device_lists);
  auto& commands = tick.commands.device_commands;
  for (std::size_t i = commands.size(); i < layout.device_commands.size(); ++i) {
    commands.push_back(layout.device_commands[i]->initial);
  }
  for (std::size_t r = started_; r < robots_.size(); ++r) {
    const world::Range& devices = robots_[r].devices;
    for (std::size_t i = devices.begin; i < devices.end(); ++i) {
      const world::DescribedDevice& device = layout.described[i];
      if (device.rows.count == 0) continue;
      tick.observations.device_rows[device.rows.begin].width = kind_.readings.size();
    }
  }
  started_ = robots_.size();
}

void Described::apply(Tick& tick) {
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    const std::size_t entity = tick.layout.robots[robots_[i].index].entity;
    const world::Range& commands = tick.layout.described[robots_[i].devices.begin].commands;
    if (commands.count == 0 || tick.state.is_absent(entity)) continue;
    act(tick, i, entity,
        std::span(tick.commands.device_commands).subspan(commands.begin, commands.count));
  }
}

void Described::sense(Tick& tick) {
  for (Robot& robot : robots_) {
    if (!robot.use.sensor) continue;
    if (!tick.state.is_absent(tick.layout.robots[robot.index].entity)) read(tick, robot);
  }
}

void Described::archive(math::Archive& archive) {
  for (Robot& robot : robots_) archive("random", robot.random);
}

double Described::with_noise(Robot& robot, double reading) {
  const double noise = robot.use.noise;
  return noise > 0 ? reading + robot.random.uniform(-noise, noise) : reading;
}

}  // namespace ziggurat::devices
