// SPDX-License-Identifier: MIT
#include "scene/memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <variant>

#include "scene/draft.h"

namespace ziggurat::scene {
namespace {

// Measured with scenes of many of each, in whole [bytes].
constexpr std::size_t of_entity = 2000, of_link = 2000, of_joint = 600, of_corner = 100;
constexpr std::size_t of_led = 350, of_directional_led = 450, of_tag = 550, of_radio = 400,
                      of_magnet = 1100;
constexpr std::size_t of_proximity = 250, of_range_and_bearing = 1000, of_param = 200;
constexpr std::size_t of_ancestor = 20;  // of a link, that moves by a joint of its own
constexpr std::size_t of_place = 500;
constexpr std::size_t of_joint_use = 300, of_camera = 600, of_mounted = 500;
constexpr std::size_t copies_of_text = 4;

std::size_t memory_of_text(const std::string& text) { return copies_of_text * text.size(); }

std::size_t memory_of(const Link& link) {
  const Hull* hull = std::get_if<Hull>(&link.geometry);
  const std::size_t corners = hull && hull->polyhedron ? hull->polyhedron->vertices.size() : 0;
  return of_link + of_corner * corners + memory_of_text(link.id);
}

std::size_t memory_of(const ProximitySensor& sensor) {
  return of_proximity +
         (sensor.response ? 2 * sizeof(Response::Point) * sensor.response->points.size() : 0);
}

std::size_t memory_of(const Camera& camera) {
  const std::size_t pixels =
      camera.image ? std::size_t{camera.resolution[0]} * camera.resolution[1] : 0;
  return of_camera + 3 * pixels + sizeof(Detector) * camera.detectors.size() +
         memory_of_text(camera.id);
}

/// Memory of a list of devices, each with an id.
template <class List>
std::size_t memory_of_each(const List& list, std::size_t each) {
  std::size_t sum = each * list.size();
  for (const auto& device : list) sum += memory_of_text(device.id);
  return sum;
}

std::size_t memory_of(const Devices& devices) {
  std::size_t sum = memory_of_each(devices.leds, of_led) + memory_of_each(devices.tags, of_tag) +
                    memory_of_each(devices.directional_leds, of_directional_led) +
                    memory_of_each(devices.radios, of_radio) +
                    memory_of_each(devices.magnets, of_magnet);
  for (const Tag& tag : devices.tags) sum += memory_of_text(tag.payload);
  for (const ProximitySensor& sensor : devices.proximity_sensors) sum += memory_of(sensor);
  sum += of_place * devices.places.size();
  if (devices.range_and_bearing)
    sum += of_range_and_bearing + 3 * devices.range_and_bearing->data_size;
  return sum;
}

/// Equations of motion have a term for each joint and each that carries it.
std::size_t memory_of_tree(const Entity& entity) {
  std::vector<std::size_t> moving(entity.links.size(), 0);  // joints from the root to each link
  std::size_t pairs = 0;
  for (const Joint& joint : entity.joints) {
    moving[joint.child] = moving[joint.parent] + (joint.type == JointType::fixed ? 0 : 1);
    pairs += moving[joint.child];
  }
  return of_ancestor * pairs;
}

std::string megabytes(std::size_t bytes) {
  return fmt::format("{:.1f} MB", static_cast<double>(bytes) / 1e6);
}

}  // namespace

std::size_t memory_of(const Params& params) {
  std::size_t sum = of_param * params.size();
  for (const auto& [name, value] : params) sum += memory_of_text(name) + memory_of_text(value);
  return sum;
}

std::size_t memory_of_mounted(const std::string& id) { return of_mounted + memory_of_text(id); }

std::size_t memory_of(const ControllerDevices& devices) {
  std::size_t sum =
      of_joint_use * (devices.joints.actuators.size() + devices.joints.sensors.size()) +
      devices.mounted_memory;
  if (!devices.cameras) return sum;
  for (const Camera& camera : devices.cameras->cameras) sum += memory_of(camera);
  return sum;
}

std::size_t memory_of(const Entity& entity, const Controller* controller) {
  std::size_t sum = of_entity + memory_of_text(entity.id) + memory_of(entity.devices) +
                    memory_of_each(entity.joints, of_joint) + memory_of_tree(entity);
  for (const Link& link : entity.links) sum += memory_of(link);
  if (!controller) return sum;
  return sum + memory_of(controller->devices) +
         memory_of(entity.overrides_params ? entity.params : controller->params);
}

void take_memory(Draft& draft, const Element& element, std::size_t memory, std::size_t written) {
  const std::size_t size = memory / memory_per_byte;
  if (size <= written) return;
  if (size - written > draft.budget.bytes) {
    element.fault(fmt::format(
        "takes some {} of memory, with what its model and its controller have, and the scene has "
        "{} "
        "left; use fewer or smaller ones, or raise --max-scene-size",
        megabytes(memory), megabytes((draft.budget.bytes + written) * memory_per_byte)));
    throw TooManyFaults{};
  }
  draft.budget.bytes -= size - written;
}

void take_copies(Draft& draft, const Element& element, std::size_t each, std::uint64_t copies) {
  const std::size_t most = draft.budget.bytes * memory_per_byte / each;
  if (copies > most) {
    element.fault_at(
        "quantity",
        fmt::format(
            "is too many: each of these entities takes some {} of memory, and the scene has "
            "{} left; write at most {}, or raise --max-scene-size",
            megabytes(each), megabytes(draft.budget.bytes * memory_per_byte), most + 1));
    throw TooManyFaults{};
  }
  draft.budget.bytes -= std::min(draft.budget.bytes, copies * each / memory_per_byte);
}

}  // namespace ziggurat::scene
