// SPDX-License-Identifier: MIT
// Contact sensors: whether something touches a link, and the force of all its contacts in the last
// tick. Links of the same entity do not touch each other.

#include <array>
#include <cstddef>
#include <unordered_map>
#include <vector>

#include "devices/kind.h"

namespace ziggurat::devices {
namespace {

class ContactSensors final : public Kind {
 public:
  std::unique_ptr<Kind> clone() const override { return std::make_unique<ContactSensors>(*this); }

  void lay_out(const Carrier& carrier, world::RobotLayout& robot,
               world::Layout& layout) const override {
    const std::size_t links = layout.entities[carrier.index].links.begin;
    robot.contact_sensors =
        append(carrier.enabled.contact_sensors, layout.contact_sensors, [&](const auto& sensor) {
          const scene::Anchor anchor = carrier.anchor(sensor.anchor);
          const std::size_t link = anchor.link == scene::Anchor::origin
                                       ? carrier.entity.reference_link
                                       : static_cast<std::size_t>(anchor.link);
          return world::ContactSensorLayout{sensor.id, sensor.anchor, carrier.index, links + link};
        });
  }

  void add(const Setting& setting) override {
    tick_length_ = setting.substep * setting.scene.physics.iterations;
    for (const world::RobotLayout& robot : setting.new_robots()) {
      const world::Range& sensors = robot.contact_sensors;
      std::unordered_map<std::size_t, std::size_t> first_of;  // sensor of each link
      for (std::size_t i = sensors.begin; i < sensors.end(); ++i) {
        const std::size_t link = setting.layout.contact_sensors[i].link;
        first_of_link_.push_back(first_of.emplace(link, i).first->second);
        setting.physics.watch_contacts(robot.entity, link_in_entity(setting.layout, i));
      }
    }
  }

  void start(Tick& tick) override {
    tick.observations.contact_sensors.resize(tick.layout.contact_sensors.size());
  }

  void sense(Tick& tick) override {
    const auto& sensors = tick.layout.contact_sensors;
    for (std::size_t i = 0; i < sensors.size(); ++i) {
      const world::ContactSensorLayout& sensor = sensors[i];
      if (tick.state.is_absent(sensor.entity)) continue;
      auto& readings = tick.observations.contact_sensors;
      if (first_of_link_[i] != i) {  // a link can be asked once
        readings[i] = readings[first_of_link_[i]];
        continue;
      }
      const physics::LinkTouch touch =
          tick.physics.take_touch(sensor.entity, link_in_entity(tick.layout, i));
      const math::Vector3 force =
          tick.state.links[sensor.link].pose.orientation.conjugate() * touch.impulse / tick_length_;
      readings[i] = {touch.touched ? 1.0 : 0.0,
                     {force.x(), force.y(), force.z()},
                     touch.magnitude / tick_length_};
    }
  }

 private:
  static std::size_t link_in_entity(const world::Layout& layout, std::size_t sensor) {
    const world::ContactSensorLayout& found = layout.contact_sensors[sensor];
    return found.link - layout.entities[found.entity].links.begin;
  }

  double tick_length_ = 0;                  // physical [s]
  std::vector<std::size_t> first_of_link_;  // parallel to Layout::contact_sensors
};

}  // namespace

std::unique_ptr<Kind> make_contact_sensors() { return std::make_unique<ContactSensors>(); }

}  // namespace ziggurat::devices
