// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdint>
#include <vector>

#include "wire/observation.h"

namespace ziggurat::wire {
namespace {

using Doubles = google::protobuf::RepeatedField<double>;
using Integers = google::protobuf::RepeatedField<std::uint32_t>;

/// Calls visit(entries of a camera) for each of the cameras; the entries ascend by camera.
template <typename Entry, typename Visit>
void for_each_camera(const std::vector<std::size_t>& cameras, const std::vector<Entry>& entries,
                     Visit visit) {
  auto begin = entries.begin();
  for (const std::size_t camera : cameras) {
    begin = std::lower_bound(
        begin, entries.end(), camera,
        [](const Entry& entry, std::size_t wanted) { return entry.camera < wanted; });
    const auto end = std::upper_bound(
        begin, entries.end(), camera,
        [](std::size_t wanted, const Entry& entry) { return wanted < entry.camera; });
    visit(std::span(begin, end));
    begin = end;
  }
}

void add_point(const math::Vector2& point, Doubles& to) {
  to.Add(point.x());
  to.Add(point.y());
}

void add_leds(const std::vector<std::size_t>& cameras,
              const std::vector<world::LedReading>& readings, Integers& counts, Integers& colors,
              Doubles& centers) {
  for_each_camera(cameras, readings, [&](std::span<const world::LedReading> seen) {
    counts.Add(static_cast<std::uint32_t>(seen.size()));
    for (const world::LedReading& led : seen) {
      colors.Add(led.color);
      add_point(led.center, centers);
    }
  });
}

void add_tags(const Roster& roster, const std::vector<world::TagReading>& readings,
              std::span<const std::string> payloads, v1::Observation& to) {
  for_each_camera(roster.tag_cameras, readings, [&](std::span<const world::TagReading> seen) {
    to.add_tag_counts(static_cast<std::uint32_t>(seen.size()));
    for (const world::TagReading& tag : seen) {
      *to.add_tag_payloads() = payloads[tag.tag];
      add_point(tag.center, *to.mutable_tag_centers());
      for (const auto& corner : tag.corners) add_point(corner, *to.mutable_tag_corners());
    }
  });
}

}  // namespace

void count_cameras(const Roster& roster, const world::Observations& from,
                   std::span<const std::string> tag_payloads, ReadingSize& to) {
  constexpr std::size_t size_of_led = 1 + 2 * sizeof(double), size_of_tag = 2 + 10 * sizeof(double);
  const auto count_leds = [&](const auto& cameras, const auto& readings) {
    for_each_camera(cameras, readings, [&](auto seen) { to.size += seen.size() * size_of_led; });
  };
  count_leds(roster.led_cameras, from.leds);
  count_leds(roster.directional_led_cameras, from.directional_leds);
  for_each_camera(roster.tag_cameras, from.tags, [&](std::span<const world::TagReading> seen) {
    to.size += seen.size() * size_of_tag;
    for (const world::TagReading& tag : seen) to.add_payload(tag_payloads[tag.tag].size());
  });
  for_each_camera(roster.image_cameras, from.images, [&](std::span<const world::Image> taken) {
    to.size += 1 + (taken.empty() ? 0 : taken.front().rgb.size());
  });
}

void add_cameras(const Roster& roster, const world::Observations& from,
                 std::span<const std::string> tag_payloads, v1::Observation& to) {
  add_leds(roster.led_cameras, from.leds, *to.mutable_led_counts(), *to.mutable_led_colors(),
           *to.mutable_led_centers());
  add_leds(roster.directional_led_cameras, from.directional_leds,
           *to.mutable_directional_led_counts(), *to.mutable_directional_led_colors(),
           *to.mutable_directional_led_centers());
  add_tags(roster, from.tags, tag_payloads, to);
  for_each_camera(roster.image_cameras, from.images, [&](std::span<const world::Image> taken) {
    std::string& image = *to.add_camera_images();
    if (taken.empty()) return;
    const std::vector<std::uint8_t>& rgb = taken.front().rgb;
    image.assign(reinterpret_cast<const char*>(rgb.data()), rgb.size());
  });
}

}  // namespace ziggurat::wire
